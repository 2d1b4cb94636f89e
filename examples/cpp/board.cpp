// A sensory node: an inertial sensor on a board, which somebody shakes now and then.
//
// The sensor is made up, so that nothing need be bought. Put the driver of yours in its place:
// whatever publishes /imu is drawn, recorded and understood by all that hears a watch.
#include <cmath>

#include "nep.hpp"

namespace {

constexpr double GRAVITY_M_S2 = 9.81;
constexpr double BATCH_S = 0.02;
constexpr double TURN_S = 0.125;  // one shake there and back
constexpr double PI = 3.14159265358979;

using Row = std::vector<double>;  // x, y, z

struct Sensor {
    double every_s;  // how often it is shaken; 0: never

    bool is_shaken(double t_s) const {
        return every_s > 0 && std::fmod(t_s, every_s) > every_s - 1.0;
    }
    Row acceleration_m_s2(double t_s) const {  // a sensor at rest feels what holds it up
        const double shake = is_shaken(t_s) ? 25.0 * std::sin(2 * PI * t_s / TURN_S) : 0.0;
        return {shake, 0.0, GRAVITY_M_S2};
    }
    Row turning_rad_s(double) const { return {0.0, 0.0, 0.0}; }
};

void work(nep::Node& node) {
    const double rate_hz = node.number("rate_hz");
    const Sensor sensor{node.number("shaken_every_s")};
    auto& imu = node.publisher("/imu");
    node.ready("an inertial sensor with " + std::to_string(int(rate_hz)) + " samples a second");
    const auto start = nep::Clock::now();
    long sent = 0;
    while (!node.wait(BATCH_S)) {
        const double now_s = nep::Seconds(nep::Clock::now() - start).count();
        std::vector<double> times;
        std::vector<Row> accelerations, turnings;
        for (; sent / rate_hz < now_s; ++sent) {  // what the sensor has measured since
            times.push_back(sent / rate_hz);
            accelerations.push_back(sensor.acceleration_m_s2(times.back()));
            turnings.push_back(sensor.turning_rad_s(times.back()));
        }
        if (times.empty()) continue;
        imu.send({{"source", "board"},
                  {"rate_hz", rate_hz},
                  {"t", times},
                  {"acc", accelerations},
                  {"gyr", turnings},
                  {"simulated", true}});
    }
}

}  // namespace

int main(int count, char** words) { return nep::run("board", "sensory", count, words, work); }
