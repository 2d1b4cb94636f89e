// What all of NEP's wire needs: bytes between NULs, ids, clocks, and where we are.
#pragma once

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>
#include <zmq.hpp>
#ifdef _WIN32
#include <process.h>
#else
#include <unistd.h>
#endif

namespace nep {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

inline const std::string NUL(1, '\0');
inline const std::string PRIVATE = "\xffs";  // how private topics begin, and no text does
constexpr int HIGH_WATER_MARK = 4000;         // frames that wait for one that is slow
inline volatile std::sig_atomic_t asked_to_stop = 0;

// What a person can act on: a sentence, and steps to try.
struct Error : std::runtime_error {
    explicit Error(const std::string& sentence, std::vector<std::string> steps = {})
        : std::runtime_error(sentence), checklist(std::move(steps)) {}
    std::vector<std::string> checklist;
};

inline double seconds_since_1970() {
    return Seconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

inline std::int64_t nanoseconds_since_1970() {
    using namespace std::chrono;
    return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

inline std::string random_id() {
    std::random_device random;
    std::string id;
    for (int i = 0; i < 32; ++i) id += "0123456789abcdef"[random() % 16];
    return id;
}

inline std::string variable(const char* name, const std::string& otherwise) {
    const char* value = std::getenv(name);
    return value && *value ? value : otherwise;
}

inline std::string host_name() {
#ifdef _WIN32
    return variable("COMPUTERNAME", "");
#else
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
#endif
}

inline int process_id() {
#ifdef _WIN32
    return _getpid();
#else
    return getpid();
#endif
}

// Where to connect: over p2p to the master alone, and to each publisher where it is; else to a
// broker, which passes everything on, and has a master two ports further.
struct Places {
    std::string master, to_publish, to_hear;
};

inline Places places() {
    const std::string network = variable("NEP_NETWORK", "p2p");
    if ((network != "p2p" && network != "broker") || !variable("NEP_KEYS", "").empty())
        throw Error("This node can join only a p2p or broker network that is not open to others.",
                    {"Start it without NEP_NETWORK and NEP_KEYS.", "Or use a node in Python."});
    if (network == "p2p") return {variable("NEP_MASTER", "tcp://127.0.0.1:7100"), "", ""};
    const std::string broker = variable("NEP_BROKER", "tcp://127.0.0.1:7110");
    const auto start = broker.rfind(':') + 1;
    const auto further = [&](int ports) {
        return broker.substr(0, start) + std::to_string(std::stoi(broker.substr(start)) + ports);
    };
    return {further(2), broker, further(1)};
}

// The parts of `bytes` between NULs, at most `most` of them (0: all).
inline std::vector<std::string> split(const std::string& bytes, std::size_t most = 0) {
    std::vector<std::string> parts;
    std::size_t start = 0, end;
    while ((!most || parts.size() + 1 < most) && (end = bytes.find('\0', start)) != bytes.npos) {
        parts.push_back(bytes.substr(start, end - start));
        start = end + 1;
    }
    parts.push_back(bytes.substr(start));
    return parts;
}

inline bool begins_with(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

// Receives into `frame` without waiting; false when there is nothing.
inline bool receive(zmq::socket_t& socket, std::string& frame) {
    zmq::message_t message;
    if (!socket.recv(message, zmq::recv_flags::dontwait)) return false;
    frame = message.to_string();
    return true;
}

}  // namespace nep
