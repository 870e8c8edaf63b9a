#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/compute/processor_error.h"
#include "engine/core/enum_names.h"

namespace palp::compute {

/// Words for processors, in any case. The host is the processor of this machine: it needs no driver and is not in the
/// list.
inline constexpr std::string_view kAutoProcessor = "auto", kHostProcessor = "host", kLavapipeProcessor = "lavapipe";

/// Returns whether `given` is the word, in any case.
[[nodiscard]] bool isProcessorWord(std::string_view given, std::string_view word);

/// What sort of processor it is. Vulkan's drivers say it of theirs, and the host is a kind of its own.
enum class ProcessorKind { discrete, integrated, virtualGpu, software, other, host };
constexpr auto namesOf(ProcessorKind)
{
    using enum ProcessorKind;
    return std::to_array<NamedValue<ProcessorKind>>({{discrete, "discrete"},
                                                     {integrated, "integrated"},
                                                     {virtualGpu, "virtual"},
                                                     {software, "software"}, // Vulkan on this machine's own processor
                                                     {other, "other"},       // of a sort that the driver does not name
                                                     {host, "host"}});
}

/// One processor: one of Vulkan, as its driver describes it, or the host.
struct Processor {
    int                      index = 0; ///< place in the list of this machine; of the host: -1
    std::string              name;      ///< as the driver spells it, or kHostProcessor
    ProcessorKind            kind = ProcessorKind::other;
    std::string              driver;          ///< name and version; of the host: empty
    std::string              api;             ///< Vulkan version, such as 1.3.230; of the host: empty
    bool                     float64 = false; ///< shaders may use double
    std::uint64_t            memory  = 0;     ///< [byte] the largest heap of its own
    std::vector<std::string> refusals;        ///< why it cannot be used; empty: it can
};

/// Lists every Vulkan processor of this machine, or nothing if there is no driver. It loads every driver, which takes
/// tens of milliseconds.
/// \throws ProcessorError if Vulkan does not start, or cannot tell
[[nodiscard]] std::vector<Processor> listProcessors();

[[nodiscard]] Processor describeHost();

/// Finds the place in the list of the processor that is wanted; empty stands for the host.
///
/// \param wanted  "auto": the first usable GPU, discrete before integrated before virtual; without one the host, whose
///                native code is 15 to 30 times faster than shaders in software and gives the same bits;
///                "host"; "lavapipe": Vulkan in software; an INDEX of the list; or part of a NAME that fits one usable
///                processor only. Words and names may be in any case.
/// \throws UnknownProcessor if the word is wrong and another GPU could be used, with one line per processor
/// \throws ProcessorError if the processor that it names cannot be used, or if no GPU can, with one line per processor
/// \thread pure
[[nodiscard]] std::optional<std::size_t> chooseProcessor(const std::vector<Processor>& processors,
                                                         std::string_view              wanted);

} // namespace palp::compute
