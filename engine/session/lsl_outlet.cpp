#include "engine/session/lsl_outlet.h"

#include <array>
#include <chrono>
#include <cstring>
#include <type_traits>
#include <vector>

#include <dlfcn.h>
#include <unistd.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

// The functions of liblsl that are used, as its manual describes them; streams and descriptions are opaque pointers.
using MakeInfo    = void*(const char* name, const char* type, std::int32_t channels, double rate, int format,
                       const char* source);
using Destroy     = void(void* what);
using MakeOutlet  = void*(void* info, std::int32_t chunk, std::int32_t seconds);
using PushDoubles = std::int32_t(void* outlet, const double* values, double time, std::int32_t through);
using PushTexts   = std::int32_t(void* outlet, const char** texts, double time, std::int32_t through);
using LocalClock  = double();
using Description = void*(void* info);
using AppendChild = void*(void* element, const char* name);
using AppendValue = void*(void* element, const char* name, const char* value);

constexpr int          kDoubles = 2, kTexts = 3; // numbers of liblsl's formats of channels
constexpr double       kRate         = 1000;     // [1/s] of ticks
constexpr std::int32_t kMostBuffered = 360;      // [s] for a receiver that stops; what liblsl takes if nothing is said

struct CloseLibrary {
    void operator()(void* library) const { ::dlclose(library); }
};
using Library = std::unique_ptr<void, CloseLibrary>;

Library openLibrary(const std::string& named)
{
    constexpr std::array kNames = {"liblsl.so", "liblsl.so.2", "liblsl.so.1"};
    std::string          why;
    if (!named.empty()) {
        if (void* library = ::dlopen(named.c_str(), RTLD_NOW | RTLD_LOCAL)) return Library(library);
        why = ::dlerror();
    } else {
        for (const char* name : kNames) {
            if (void* library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return Library(library);
            if (why.empty()) why = ::dlerror();
        }
    }
    throw Error("--stream lsl: expected the library liblsl, found none (" + why +
                "); install liblsl of the Lab Streaming Layer where the system finds it, or name its folder in "
                "LD_LIBRARY_PATH; --stream udp:HOST:PORT needs no library");
}

/// One stream: its description, then its outlet.
struct Stream {
    void*    info        = nullptr;
    void*    outlet      = nullptr;
    Destroy *destroyInfo = nullptr, *destroyOutlet = nullptr;

    Stream()                         = default;
    Stream(const Stream&)            = delete;
    Stream& operator=(const Stream&) = delete;
    ~Stream()
    {
        if (outlet) destroyOutlet(outlet);
        if (info) destroyInfo(info);
    }
};

} // namespace

struct LslOutlet::Impl {
    Impl(std::string of, const std::string& file) : name(std::move(of)), library(openLibrary(file))
    {
        find(makeInfo, "lsl_create_streaminfo");
        find(makeOutlet, "lsl_create_outlet");
        find(pushDoubles, "lsl_push_sample_dtp");
        find(pushTexts, "lsl_push_sample_strtp");
        find(localClock, "lsl_local_clock");
        find(description, "lsl_get_desc");
        find(appendChild, "lsl_append_child");
        find(appendValue, "lsl_append_child_value");
        for (const SessionColumn& column : sessionColumns()) values.resize(values.size() + column.components);
        makeStream(ticks, name, "Haptics", std::int32_t(values.size()), kRate, kDoubles);
        describeChannels();
        openStream(ticks);
        makeStream(markers, name + " Markers", "Markers", 1, 0, kTexts);
        openStream(markers);
    }

    template <class Function>
    void find(Function*& function, const char* symbol)
    {
        function = reinterpret_cast<Function*>(::dlsym(library.get(), symbol));
        if (!function)
            throw Error(std::string("--stream lsl: the library liblsl that was found has no ") + symbol +
                        "; expected version 1.13 or later");
    }

    void makeStream(Stream& stream, const std::string& as, const char* type, std::int32_t channels, double rate,
                    int format)
    {
        find(stream.destroyInfo, "lsl_destroy_streaminfo");
        find(stream.destroyOutlet, "lsl_destroy_outlet");
        const std::string source = "palpate-" + std::to_string(::getpid()) + "-" + as;
        stream.info              = makeInfo(as.c_str(), type, channels, rate, format, source.c_str());
        if (!stream.info) throw Error("--stream lsl: liblsl could not describe the stream \"" + as + "\"");
    }

    /// Names each channel and its unit, where receivers look for them.
    void describeChannels()
    {
        void* const channels = appendChild(description(ticks.info), "channels");
        for (const SessionColumn& column : sessionColumns())
            for (std::size_t k = 0; k < column.components; ++k) {
                void* const channel = appendChild(channels, "channel");
                appendValue(channel, "label", column.componentName(k).c_str());
                appendValue(channel, "unit", std::string(column.unit).c_str());
                appendValue(channel, "type", "Haptics");
            }
    }

    void openStream(Stream& stream)
    {
        stream.outlet = makeOutlet(stream.info, 0, kMostBuffered);
        if (!stream.outlet) throw Error("--stream lsl: liblsl could not offer the stream \"" + name + "\"");
    }

    /// Returns a time of the session on the layer's clock [s].
    double onItsClock(double time, const SessionClocks& clocks) noexcept
    {
        if (clocks.monotonic != start) {
            const auto now = std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
            start          = clocks.monotonic;
            startOnIts     = localClock() - 1e-9 * double(now - start);
        }
        return startOnIts + time;
    }

    std::string         name;
    Library             library; ///< outlives the streams
    MakeInfo*           makeInfo    = nullptr;
    MakeOutlet*         makeOutlet  = nullptr;
    PushDoubles*        pushDoubles = nullptr;
    PushTexts*          pushTexts   = nullptr;
    LocalClock*         localClock  = nullptr;
    Description*        description = nullptr;
    AppendChild*        appendChild = nullptr;
    AppendValue*        appendValue = nullptr;
    Stream              ticks, markers;
    std::vector<double> values;         ///< of a tick
    std::int64_t        start      = 0; ///< [ns] CLOCK_MONOTONIC of time 0
    double              startOnIts = 0; ///< [s] the same on the layer's clock
};

LslOutlet::LslOutlet(const std::string& name, const std::string& library) : impl_(std::make_unique<Impl>(name, library))
{
}

LslOutlet::~LslOutlet() = default;

std::string LslOutlet::name() const
{
    return "lsl:" + impl_->name;
}

bool LslOutlet::send(const StreamedTick& tick) noexcept
{
    auto to = impl_->values.begin();
    for (const SessionColumn& column : sessionColumns()) {
        const char* from = reinterpret_cast<const char*>(&tick.record) + column.offset;
        for (std::size_t k = 0; k < column.components; ++k, from += column.recordBytes()) {
            const auto read = [&](auto number) {
                std::memcpy(&number, from, sizeof number);
                *to++ = double(number);
            };
            if (column.recordBytes() == sizeof(double))
                read(double());
            else if (column.type == SessionColumn::Type::int32)
                read(std::int32_t());
            else
                read(std::uint32_t());
        }
    }
    return impl_->pushDoubles(impl_->ticks.outlet, impl_->values.data(),
                              impl_->onItsClock(tick.record.time, tick.clocks), 1) == 0;
}

bool LslOutlet::send(const StreamedMarker& marker) noexcept
{
    const char* text = marker.marker.text.c_str();
    return impl_->pushTexts(impl_->markers.outlet, &text, impl_->onItsClock(marker.marker.time, marker.clocks), 1) == 0;
}

} // namespace palp
