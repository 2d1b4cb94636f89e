// NEP for C++: a node that joins the master, talks, tells how it is doing, and stops when asked.
//
// All of it runs in the one thread that calls wait(): no locks, and callbacks come one at a time.
// So call wait() at least once a second; a node that is silent for 3 s is taken for dead.
// docs/wire.md describes what goes over the wire, in the words that are used here.
#pragma once

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "nep/outbox.hpp"
#include "nep/subscription.hpp"
#include "nep/wire.hpp"

namespace nep {

// A node. It throws Error when there is no master, or when the name is taken.
class Node {
   public:
    using Settings = std::map<std::string, std::string>;

    Node(const std::string& name, const std::string& type, Settings settings = {})
        : name_(name), type_(type), settings_(std::move(settings)) {
        master_.set(zmq::sockopt::linger, 200);
        master_.set(zmq::sockopt::immediate, 1);  // nothing piles up while the master is away
        master_.set(zmq::sockopt::reconnect_ivl_max, 500);
        master_.connect(places_.master);
        states_ = &publisher("/node_state", true);
        state("starting");
    }

    ~Node() { close(); }
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;

    // A setting: the launcher gives all of the manifest.
    std::string setting(const std::string& name) const {
        const auto found = settings_.find(name);
        if (found != settings_.end()) return found->second;
        throw Error("The setting " + name + " is missing.", {"Write it, as in " + name + "=5."});
    }

    double number(const std::string& name) const {
        const std::string text = setting(name);
        try {
            return std::stod(text);
        } catch (const std::logic_error&) {
            throw Error("The setting " + name + " is no number: " + text + ".",
                        {"Write a number, such as " + name + "=0.5."});
        }
    }

    // The publisher of a topic; the subscribers that the master knows miss no message of it.
    Publisher& publisher(const std::string& topic, bool latched = false) {
        Publisher& added = outbox_.publisher(topic, latched);
        const json known = tell_master().at("subscribers").value(topic, json::array());
        tend_until(1.0, [&] {
            return std::all_of(known.begin(), known.end(), [&](const json& id) {
                return added.subscribers().count(id) > 0;
            });
        });
        return added;
    }

    // Lets `callback` have every message of a topic; it is called by wait().
    void subscribe(const std::string& topic, Subscription::Callback callback) {
        subscriptions_.emplace_back(
            new Subscription(context_, topic, std::move(callback), places_.to_hear));
        const Subscription& added = *subscriptions_.back();
        const json known = tell_master().at("publishers").value(topic, json::array());
        tend_until(1.0, [&] {
            return std::all_of(known.begin(), known.end(), [&](const json& publisher) {
                return added.is_welcomed_by(publisher.at("instance"));
            });
        });
    }

    void ready(const std::string& description = "") { state("ready", description); }
    void warn(const std::string& description) { state("warning", description); }

    // Tells everybody how the node is doing: "ready", "running", "busy", "warning", ...
    void state(const std::string& event, const std::string& description = "") {
        // A heartbeat is not kept: who comes later wants to know that the node is ready.
        states_->send({{"node", name_},
                       {"type", type_},
                       {"event", event},
                       {"description", description},
                       {"pid", process_id()},
                       {"host", host_name()},
                       {"time", seconds_since_1970()}},
                      event != "alive");
    }

    // Works for so many seconds; true, and at once, when the node is asked to stop.
    bool wait(double seconds) {
        const auto end = Clock::now() + Seconds(seconds);
        do {
            tend(Seconds(end - Clock::now()).count());
            for (auto& one : subscriptions_) one->call_back();
        } while (!asked_to_stop && Clock::now() < end);
        return asked_to_stop;
    }

    // How the launcher knows that it is not to be started again.
    int exit_code() const { return asked_by_network_ ? 71 : 0; }

    // Says how it ended, and leaves.
    void close(const std::string& event = "stopped", const std::string& description = "") {
        if (!states_) return;  // it never was there
        state(event, description);
        say({{"do", "bye"}, {"instance", instance_}});
        states_ = nullptr;
    }

   private:
    // Does what is due, for so many seconds, or until something comes.
    void tend(double seconds) {
        std::vector<zmq::pollitem_t> sockets{{master_.handle(), 0, ZMQ_POLLIN, 0},
                                             outbox_.to_poll()};
        for (auto& one : subscriptions_) sockets.push_back(one->to_poll());
        const int pause_ms = static_cast<int>(1000 * std::clamp(seconds, 0.0, TICK_S));
        try {
            zmq::poll(sockets, std::chrono::milliseconds(pause_ms));
        } catch (const zmq::error_t& error) {
            if (error.num() != EINTR) throw;  // a signal: wait() sees that it is to stop
        }
        hear_master();
        outbox_.tend();
        for (auto& one : subscriptions_) one->tend();
        stay_known();
    }

    void tend_until(double seconds, const std::function<bool()>& is_done) {
        const auto end = Clock::now() + Seconds(seconds);
        while (!is_done() && !asked_to_stop && Clock::now() < end) tend(TICK_S);
    }

    // Tells the master all that this node has, and waits for the answer.
    const json& tell_master() {
        ++version_;
        const auto is_answered = [&] { return answer_.value("version", 0) >= version_; };
        tend_until(5.0, is_answered);
        if (!is_answered())
            throw Error("No NEP master answers at " + places_.master + ".",
                        {"Open NEP Studio, or type: nep master",
                         "Is NEP_MASTER the address of the master?"});
        if (answer_.at("do") == "refused")
            throw Error(answer_.at("sentence"), answer_.at("checklist"));
        return answer_;
    }

    void stay_known() {
        const auto now = Clock::now();
        if (version_sent_ < version_ && register_all()) version_sent_ = version_;
        if (now >= next_heartbeat_) {
            next_heartbeat_ = now + std::chrono::milliseconds(500);
            if (epoch_.empty())
                version_sent_ = 0;  // no answer yet: ask once more
            else
                say({{"do", "alive"}, {"instance", instance_}});
        }
        if (now >= next_alive_ && states_) {
            next_alive_ = now + std::chrono::seconds(1);
            state("alive");
            tell_losses();
        }
    }

    bool register_all() {
        json subscribes = json::object();
        for (const auto& one : subscriptions_) subscribes[one->id()] = one->topic();
        return say({{"do", "register"},
                    {"version", version_},
                    {"epoch", epoch_},
                    {"registration",
                     {{"instance", instance_},
                      {"node", name_},
                      {"pid", process_id()},
                      {"host", host_name()},
                      {"endpoint", outbox_.endpoint()},
                      {"publishes", outbox_.topics()},
                      {"subscribes", subscribes}}}});
    }

    void hear_master() {
        std::string frame;
        while (receive(master_, frame)) {
            const json said = json::parse(frame);
            const std::string what = said.at("do");
            if (what == "registered") {
                epoch_ = said.at("epoch");
                for (const auto& [topic, publishers] : said.at("publishers").items())
                    connect(topic, publishers);
            }
            if (what == "registered" || what == "refused") answer_ = said;
            if (what == "error")  // it could not use what we said
                answer_ = {{"do", "refused"},
                           {"version", version_},
                           {"sentence", said.at("sentence")},
                           {"checklist", json::array()}};
            if (what == "publishers") connect(said.at("topic"), said.at("publishers"));
            if (what == "heard" && (!said.at("known") || said.at("epoch") != epoch_))
                version_sent_ = 0;  // another master: it wants to know everything
            if (what == "stop_asked") asked_to_stop = asked_by_network_ = true;
        }
    }

    void connect(const std::string& topic, const json& publishers) {
        if (!places_.to_hear.empty()) return;  // they are all behind the broker
        for (auto& one : subscriptions_)
            if (one->topic() == topic) one->connect(publishers);
    }

    bool say(const json& request) {
        return master_.send(zmq::buffer(request.dump()), zmq::send_flags::dontwait).has_value();
    }

    // Lost messages are no secret: somebody should look.
    void tell_losses() {
        std::int64_t lost = 0;
        for (const auto& one : subscriptions_) lost += one->lost();
        const std::int64_t news = lost - lost_told_;
        if (news > 0) warn("Messages were lost: " + std::to_string(news) + ".");
        lost_told_ = lost;
    }

    static constexpr double TICK_S = 0.02;
    const std::string name_, type_, instance_ = random_id();
    const Places places_ = places();
    const Settings settings_;
    zmq::context_t context_;
    zmq::socket_t master_{context_, zmq::socket_type::dealer};
    Outbox outbox_{context_, name_, instance_, places_.to_publish};
    std::vector<std::unique_ptr<Subscription>> subscriptions_;
    Publisher* states_ = nullptr;
    std::int64_t version_ = 0, version_sent_ = 0, lost_told_ = 0;
    json answer_ = json::object();
    std::string epoch_;
    bool asked_by_network_ = false;
    Clock::time_point next_heartbeat_ = Clock::now();
    Clock::time_point next_alive_ = next_heartbeat_ + std::chrono::seconds(1);
};

// Tells the launcher, if there is one, why the node cannot go on: a person sees it.
inline void hand_over(const Error& error) {
    const char* place = std::getenv("NEP_FAULT_FILE");
    if (place == nullptr || *place == 0) return;
    const json fault = {
        {"code", "refused"}, {"sentence", error.what()}, {"checklist", error.checklist}};
    std::ofstream(place) << fault.dump();
}

// Runs a node to its end; what its main() returns.
//
// The launcher says how the node is called and what is set: --name NAME setting=value ...
inline int run(const std::string& usual_name, const std::string& type, int count, char** words,
               const std::function<void(Node&)>& work) {
    std::string name = usual_name;
    Node::Settings settings;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const auto equals = word.find('=');
        if (word == "--name" && i + 1 < count)
            name = words[++i];
        else if (equals != word.npos)
            settings[word.substr(0, equals)] = word.substr(equals + 1);
    }
    const auto stop = [](int) { asked_to_stop = 1; };
    std::signal(SIGTERM, stop);
    std::signal(SIGINT, stop);
#ifdef SIGBREAK
    std::signal(SIGBREAK, stop);  // how Windows asks
#endif
    try {
        Node node(name, type, settings);
        try {
            work(node);
        } catch (const std::exception& error) {
            node.close("crashed", error.what());
            throw;
        }
        return node.exit_code();
    } catch (const Error& error) {
        hand_over(error);
        std::cerr << error.what() << std::endl;
        for (const auto& step : error.checklist) std::cerr << "  [ ] " << step << std::endl;
    } catch (const std::exception& error) {
        std::cerr << error.what() << std::endl;
    }
    return 1;
}

}  // namespace nep
