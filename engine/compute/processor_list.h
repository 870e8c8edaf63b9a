#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/compute/processor_error.h"

namespace palp::compute {

/// Words for devices, in any case. The host is the processor of this machine: it needs no driver and is not in the
/// list.
inline constexpr std::string_view kAutoProcessor = "auto", kHostProcessor = "host", kLavapipeProcessor = "lavapipe";

/// Whether `given` is the word, in any case.
[[nodiscard]] bool isProcessorWord(std::string_view given, std::string_view word);

/// One device as the drivers describe it, or the host.
struct Processor {
    int                      index = 0;       ///< place in the list of this machine; of the host: -1
    std::string              name;            ///< as the driver spells it, or kHostProcessor
    std::string              kind;            ///< discrete, integrated, virtual, software, other or kHostProcessor
    std::string              driver;          ///< name and version; of the host: empty
    std::string              api;             ///< Vulkan version, such as 1.3.230; of the host: empty
    bool                     float64 = false; ///< shaders may use double
    std::uint64_t            memory  = 0;     ///< [byte] the largest heap of its own
    std::vector<std::string> refusals;        ///< why it cannot be used; empty: it can
};

/// Every Vulkan device of this machine; empty if there is no driver. Takes tens of milliseconds: it loads every driver.
/// \throws ProcessorError if Vulkan does not start, or cannot tell
[[nodiscard]] std::vector<Processor> listProcessors();

[[nodiscard]] Processor describeHost();

/// The place in the list of the device that is wanted; empty: the host.
///
/// \param wanted  "auto": the first usable GPU, discrete before integrated before virtual; without one the host, whose
///                native code is 15 to 30 times faster than shaders in software and gives the same bits;
///                "host"; "lavapipe": a software device; an INDEX of the list; or part of a NAME, whatever the case,
///                that fits one usable device only. The words in any case
/// \throws UnknownProcessor if the word is wrong and another GPU could be used; ProcessorError if what it names cannot be
///         used, or no GPU can. Both with one line per device
/// \thread pure
[[nodiscard]] std::optional<std::size_t> chooseProcessor(const std::vector<Processor>& devices,
                                                         std::string_view              wanted);

} // namespace palp::compute
