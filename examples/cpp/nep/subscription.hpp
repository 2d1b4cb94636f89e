// The receiving side: one topic that is heard, through a SUB socket of its own.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <iostream>
#include <map>
#include <set>

#include "wire.hpp"

namespace nep {

class Subscription {
   public:
    using Callback = std::function<void(const json&)>;

    Subscription(zmq::context_t& context, const std::string& topic, Callback callback,
                 const std::string& broker)
        : topic_(topic),
          private_(PRIVATE + topic + NUL + id_ + NUL),
          callback_(std::move(callback)),
          socket_(context, zmq::socket_type::sub) {
        socket_.set(zmq::sockopt::linger, 0);
        socket_.set(zmq::sockopt::rcvhwm, HIGH_WATER_MARK);
        socket_.set(zmq::sockopt::subscribe, topic + NUL);
        socket_.set(zmq::sockopt::subscribe, private_);  // after the data: the proof rests on it
        if (!broker.empty()) socket_.connect(broker);
    }

    const std::string& topic() const { return topic_; }
    const std::string& id() const { return id_; }
    std::int64_t lost() const { return lost_; }
    bool is_welcomed_by(const std::string& instance) const { return welcomed_.count(instance) > 0; }
    zmq::pollitem_t to_poll() { return {socket_.handle(), 0, ZMQ_POLLIN, 0}; }

    // Hears exactly these publishers from now on.
    void connect(const json& publishers) {
        std::set<std::string> wanted;
        for (const json& publisher : publishers) wanted.insert(publisher.at("endpoint"));
        for (const auto& endpoint : endpoints_)
            if (!wanted.count(endpoint)) leaving_[endpoint] = Clock::now();
        for (const auto& endpoint : wanted)
            if (!endpoints_.count(endpoint) && !leaving_.erase(endpoint)) socket_.connect(endpoint);
        endpoints_ = wanted;
    }

    // Takes in what has arrived, so many at a time: a flood must not keep us from our heartbeats.
    void tend() {
        std::string frame;
        for (int i = 0; i < 1000 && receive(socket_, frame); ++i) {
            if (!begins_with(frame, PRIVATE)) {
                arrived_.push_back(frame);
            } else if (begins_with(frame, private_)) {  // a welcome
                const auto parts = split(frame.substr(private_.size()), 2);
                welcomed_.insert(parts[0]);
                const bool has_notice = parts.size() == 2 && !parts[1].empty();
                if (has_notice) arrived_.push_back(parts[1]);
            }
        }
        disconnect_left();
    }

    // Calls back with all that has arrived, until the node is asked to stop.
    void call_back() {
        while (!arrived_.empty() && !asked_to_stop) {
            const std::string frame = std::move(arrived_.front());
            arrived_.pop_front();
            try {
                read(frame);
            } catch (const json::exception& error) {
                std::cerr << topic_ << ": a message cannot be read: " << error.what() << std::endl;
            }
        }
    }

   private:
    using Payloads = std::vector<std::string>;

    // The numbers of a publisher's messages: the first that came, and the last that was sent.
    struct Numbers {
        std::int64_t first = 0, last = 0;
    };

    void read(const std::string& frame) {
        const auto parts = split(frame, 3);  // topic, header, and what was sent
        if (parts.size() < 2) return;
        const json header = json::parse(parts[1]);
        const bool is_json = header.at(3) == "json";
        const auto payloads = parts.size() == 3 ? split(parts[2], is_json ? 0 : 1) : Payloads();
        const bool is_notice = header.size() > 5;
        const auto take = is_notice ? &Subscription::is_news : &Subscription::count;
        if (!(this->*take)(header, payloads.size()) || !is_json) return;
        for (const auto& payload : payloads) callback_(json::parse(payload));
    }

    Numbers& numbers_of(const json& header) {  // each start of a program counts from 1
        return numbers_[header.at(0).dump() + (header.size() > 4 ? header.at(4).dump() : "")];
    }

    // Sees what is missing before these messages; always true.
    bool count(const json& header, std::size_t messages) {
        const std::int64_t number = header.at(1);
        Numbers& of = numbers_of(header);
        if (of.first == 0) of = {number, number - 1};
        lost_ += std::max<std::int64_t>(0, number - of.last - 1);  // below: it began again
        of.last = number + std::int64_t(messages) - 1;
        return true;
    }

    // Hears how many messages there were by now; whether the latched one beside it is new to us.
    bool is_news(const json& header, std::size_t messages) {
        const std::int64_t number = header.at(1), sent = header.at(5);
        Numbers& of = numbers_of(header);
        if (of.first == 0) of = {sent + 1, sent};  // what was before is none of our business
        const bool was_lost = messages > 0 && number > of.last;
        const bool is_new = messages > 0 && (was_lost || number < of.first);
        lost_ += std::max<std::int64_t>(0, sent - of.last - (was_lost ? 1 : 0));
        of.last = std::max(of.last, sent);
        if (is_new) of.first = std::min(of.first, number);
        return is_new;
    }

    // A publisher that has left is heard a little longer: disconnecting drops what is on its way,
    // and after a restart the master does not know of all at once.
    void disconnect_left() {
        for (auto one = leaving_.begin(); one != leaving_.end();) {
            const bool is_over = Clock::now() - one->second > std::chrono::seconds(3);
            if (is_over) socket_.disconnect(one->first);
            one = is_over ? leaving_.erase(one) : std::next(one);
        }
    }

    const std::string topic_, id_ = random_id(), private_;
    const Callback callback_;
    zmq::socket_t socket_;
    std::set<std::string> endpoints_, welcomed_;
    std::map<std::string, Clock::time_point> leaving_;
    std::deque<std::string> arrived_;
    std::map<std::string, Numbers> numbers_;
    std::int64_t lost_ = 0;
};

}  // namespace nep
