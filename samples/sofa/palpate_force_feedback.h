#pragma once
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include <palpate.h>
#include <sofa/component/haptics/ForceFeedback.h>

/// Force feedback in SOFA at the device's own rate: the driver calls computeForce() in its own thread. Include it in a
/// plugin, register it there as SOFA's object factory wants it, and link libpalpate.
class PalpateForceFeedback : public sofa::component::haptics::ForceFeedback {
public:
    SOFA_CLASS(PalpateForceFeedback, sofa::component::haptics::ForceFeedback);

    sofa::Data<std::string> d_scene{initData(&d_scene, std::string(), "scene", "scene file of Palpate")};
    sofa::Data<double>      d_metres{initData(&d_metres, 0.01, "metres", "in a unit of length of the driver")};
    sofa::Data<double>      d_force{initData(&d_force, 3.0, "maximumForce", "that the device holds [N]")};
    sofa::Data<double>      d_stiffness{
        initData(&d_stiffness, 1000.0, "maximumStiffness", "of a wall that the device renders stably at 1 kHz [N/m]")};

    ~PalpateForceFeedback() override
    {
        const std::lock_guard gate(gate_); // the driver's thread may be in a step
        palpate_session_destroy(std::exchange(session_, nullptr));
    }

    void init() override
    {
        ForceFeedback::init();
        palpate_object* object = nullptr;
        check(palpate_object_from_file(d_scene.getValue().c_str(), &object));
        auto device              = PALPATE_INIT(palpate_session_settings);
        device.maximum_force     = d_force.getValue();
        device.maximum_stiffness = d_stiffness.getValue();
        palpate_session* session = nullptr;
        const int        code    = palpate_session_create(object, &device, &session);
        palpate_object_destroy(object);
        check(code);
        const std::lock_guard gate(gate_);
        metres_ = d_metres.getValue();
        palpate_session_destroy(std::exchange(session_, session)); // of an earlier init()
    }

    /// Passes on the device's buttons, bit i for button i, from any thread. SOFA's class has no place for them, so your
    /// plugin takes them from its driver: the first one, held for 20 ms, clears a fault of the governor.
    void setButtons(std::uint32_t buttons) noexcept { buttons_ = buttons; }

    /// Returns whether the governor has stopped the force until the first button is held. From any thread.
    [[nodiscard]] bool isStopped() const noexcept { return isStopped_; }

    /// Returns why it has stopped the force, as a sentence for a person; empty if it has not. From any thread but the
    /// driver's.
    [[nodiscard]] std::string words()
    {
        if (!isStopped_) return {}; // a tick that finds the gate closed has no force, so only where there is none
        char                  text[256]{};
        const std::lock_guard gate(gate_);
        if (session_) palpate_session_words(session_, text, sizeof text);
        return text;
    }

    void computeForce(SReal x, SReal y, SReal z, SReal /*u*/, SReal /*v*/, SReal /*w*/, SReal /*q*/, SReal& fx,
                      SReal& fy, SReal& fz) override
    {
        fx = fy = fz = 0;
        const std::unique_lock gate(gate_,
                                    std::try_to_lock); // it never waits: no force while the session is made or ended
        if (!gate || !session_) return;
        const std::chrono::duration<double> now = std::chrono::steady_clock::now() - begin_;
        const double                        place[3]{metres_ * x, metres_ * y, metres_ * z};
        auto                                hand   = PALPATE_INIT(palpate_hand);
        auto                                answer = PALPATE_INIT(palpate_answer);
        move(place, now.count());
        for (int k = 0; k < 3; ++k) hand.position[k] = place[k], hand.velocity[k] = velocity_[k];
        hand.buttons = buttons_;
        palpate_session_step(session_, now.count(), &hand, &answer); // a place that is not finite: zero force
        isStopped_ = (answer.flags & PALPATE_STOPPED) != 0;
        fx = answer.force[0], fy = answer.force[1], fz = answer.force[2];
    }

    /// A tool without torques.
    void computeWrench(const sofa::defaulttype::SolidTypes<SReal>::Transform& /*tool*/,
                       const sofa::defaulttype::SolidTypes<SReal>::SpatialVector& /*speed*/,
                       sofa::defaulttype::SolidTypes<SReal>::SpatialVector& /*wrench*/) override
    {
    }

private:
    static void check(int code)
    {
        if (code != PALPATE_OK) throw std::runtime_error(palpate_error_text());
    }

    /// Takes the next place [m] at a time [s] into the smoothed velocity.
    void move(const double (&place)[3], double now) noexcept
    {
        constexpr double kSmoothing = 5e-3; // [s]
        if (!(std::isfinite(place[0]) && std::isfinite(place[1]) && std::isfinite(place[2]))) return;
        const double dt = now - time_;
        for (int k = 0; k < 3; ++k) {
            if (time_ > 0 && dt > 0)
                velocity_[k] += dt / (dt + kSmoothing) * ((place[k] - place_[k]) / dt - velocity_[k]);
            place_[k] = place[k];
        }
        time_ = now;
    }

    std::mutex                                  gate_;
    std::atomic<std::uint32_t>                  buttons_{0};
    std::atomic<bool>                           isStopped_{false};
    palpate_session*                            session_ = nullptr;
    double                                      metres_  = 0; ///< in a unit of the driver
    const std::chrono::steady_clock::time_point begin_   = std::chrono::steady_clock::now();
    double                                      time_    = 0;                ///< [s] of the last good place
    double                                      place_[3]{}, velocity_[3]{}; ///< [m], [m/s]
};
