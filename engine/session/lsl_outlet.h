#pragma once
#include <memory>
#include <string>

#include "engine/session/tick_stream.h"

namespace palp {

/// Offers ticks and markers as two streams of the Lab Streaming Layer: NAME, a channel of doubles per component of
/// sessionColumns(), and "NAME Markers", a text each. Its library is the user's own, opened while the program runs.
///
/// A sample's time is that of its tick on the layer's clock, measured at time 0.
class LslOutlet : public TickOutlet {
public:
    /// \param library  the file; empty: liblsl.so, liblsl.so.2 or liblsl.so.1, as the system finds them
    /// \throws Error naming --stream and what helps, if there is no such library or it offers no stream
    explicit LslOutlet(const std::string& name, const std::string& library = "");
    ~LslOutlet() override;

    [[nodiscard]] std::string name() const override;
    bool                      send(const StreamedTick& tick) noexcept override;
    bool                      send(const StreamedMarker& marker) noexcept override;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
