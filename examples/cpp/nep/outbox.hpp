// The sending side: one XPUB socket, its publishers, and the subscribers that are seen on it.
#pragma once

#include <map>
#include <memory>
#include <set>

#include "wire.hpp"

namespace nep {

// Sends the messages of one topic; Node::publisher() makes it.
class Publisher {
   public:
    Publisher(zmq::socket_t& socket, std::string node, std::string run, std::string topic,
              bool latched)
        : socket_(socket),
          node_(std::move(node)),
          run_(std::move(run)),
          topic_(std::move(topic)),
          latched_(latched) {}

    // Sends a JSON value. What is latched is kept for subscribers that come later.
    void send(const json& message, bool latch = true) {
        const std::string payload = message.dump();
        const json header{node_, ++sent_, nanoseconds_since_1970(), "json", run_};
        socket_.send(zmq::buffer(topic_ + NUL + header.dump() + NUL + payload),
                     zmq::send_flags::dontwait);
        if (latched_ && latch) {
            kept_header_ = header;
            kept_payload_ = payload;
        }
    }

    // The ids of the subscribers that hear this topic now.
    const std::set<std::string>& subscribers() const { return seen_; }

   private:
    friend class Outbox;

    // What a newcomer is told: how many messages there were, and the last one of a latched topic.
    std::string notice() const {
        json header = kept_header_;
        if (header.is_null()) header = {node_, sent_, nanoseconds_since_1970(), "json", run_};
        header.push_back(sent_);
        const std::string start = topic_ + NUL + header.dump();
        return kept_payload_.empty() ? start : start + NUL + kept_payload_;
    }

    zmq::socket_t& socket_;
    const std::string node_, run_, topic_;
    const bool latched_;
    json kept_header_;
    std::string kept_payload_;
    std::int64_t sent_ = 0;
    std::set<std::string> seen_;
};

class Outbox {
   public:
    Outbox(zmq::context_t& context, std::string node, std::string instance, std::string broker)
        : broker_(std::move(broker)),
          node_(std::move(node)),
          instance_(std::move(instance)),
          socket_(context, zmq::socket_type::xpub) {
        socket_.set(zmq::sockopt::linger, 500);  // the last words are still sent
        socket_.set(zmq::sockopt::sndhwm, HIGH_WATER_MARK);
        socket_.set(zmq::sockopt::xpub_verbose, true);  // a broker that is started again
        if (broker_.empty())
            socket_.bind("tcp://127.0.0.1:*");
        else
            socket_.connect(broker_);
    }

    std::string endpoint() const {
        return broker_.empty() ? socket_.get(zmq::sockopt::last_endpoint) : broker_;
    }
    zmq::pollitem_t to_poll() { return {socket_.handle(), 0, ZMQ_POLLIN, 0}; }

    // The publisher of a topic, made at first use.
    Publisher& publisher(const std::string& topic, bool latched) {
        auto& place = publishers_[topic];
        const std::string run = instance_.substr(0, 8);
        if (!place) place = std::make_unique<Publisher>(socket_, node_, run, topic, latched);
        return *place;
    }

    std::vector<std::string> topics() const {
        std::vector<std::string> names;
        for (const auto& [topic, publisher] : publishers_) names.push_back(topic);
        return names;
    }

    // Welcomes who comes: a private subscription follows that of the data on the same connection,
    // so when we see the private one, the subscriber gets all that we send from now on.
    void tend() {
        std::string event;
        while (receive(socket_, event)) {
            const bool comes = event[0] == 1;
            const std::string wanted = event.substr(1);
            if (!begins_with(wanted, PRIVATE)) continue;
            const auto parts = split(wanted.substr(PRIVATE.size()));
            if (parts.size() != 3) continue;
            const auto found = publishers_.find(parts[0]);
            Publisher* const heard = found == publishers_.end() ? nullptr : found->second.get();
            if (comes) {
                const std::string notice = heard ? heard->notice() : "";
                socket_.send(zmq::buffer(wanted + instance_ + NUL + notice),
                             zmq::send_flags::dontwait);
            }
            if (heard && comes) heard->seen_.insert(parts[1]);
            if (heard && !comes) heard->seen_.erase(parts[1]);
        }
    }

   private:
    const std::string broker_, node_, instance_;
    zmq::socket_t socket_;
    std::map<std::string, std::unique_ptr<Publisher>> publishers_;
};

}  // namespace nep
