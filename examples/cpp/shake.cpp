// A perceptual node: hears an inertial sensor, and tells when it is shaken.
//
// A rule of a block program waits for it: "when human state is shaken".
#include <cmath>

#include "nep.hpp"

namespace {

constexpr double GRAVITY_M_S2 = 9.81;
constexpr double CALM_S = 1.0;  // so long it must be calm before it can be shaken again

// How much the acceleration differs from gravity, smoothed: the same however it is held.
class Shaking {
   public:
    explicit Shaking(double strength_m_s2) : strength_m_s2_(strength_m_s2) {}

    // Takes a sample in; true when the shaking begins.
    bool hear(double t_s, double x, double y, double z, double rate_hz) {
        const double excess = std::abs(std::sqrt(x * x + y * y + z * z) - GRAVITY_M_S2);
        level_m_s2_ += (excess - level_m_s2_) * std::min(1.0, 4.0 / rate_hz);
        if (level_m_s2_ < strength_m_s2_) return false;
        const bool begins = t_s - last_s_ > CALM_S || t_s < last_s_;  // another sensor's clock
        last_s_ = t_s;
        return begins;
    }
    // From 0.5, just enough, to 1, twice as much.
    double certainty() const { return std::min(1.0, 0.5 * level_m_s2_ / strength_m_s2_); }

   private:
    double strength_m_s2_, level_m_s2_ = 0.0, last_s_ = -HUGE_VAL;
};

void work(nep::Node& node) {
    Shaking shaking(node.number("strength_m_s2"));
    auto& behavior = node.publisher("/human_behavior");
    node.subscribe("/imu", [&](const nep::json& imu) {
        const nep::json& rows = imu.at("acc");
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const nep::json& row = rows[i];
            if (shaking.hear(imu.at("t").at(i), row.at(0), row.at(1), row.at(2), imu.at("rate_hz")))
                behavior.send({{"human_state", "shaken"},
                               {"certainty", shaking.certainty()},
                               {"source", imu.at("source")},
                               {"time", nep::seconds_since_1970()}});
        }
    });
    node.ready("tells when a sensor is shaken");
    while (!node.wait(1.0)) continue;
}

}  // namespace

int main(int count, char** words) { return nep::run("shake", "perceptual", count, words, work); }
