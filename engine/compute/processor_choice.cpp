#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>

#include "engine/compute/processor_list.h"

namespace palp::compute {
namespace {

using Processors = std::vector<Processor>;

/// The kinds that "auto" takes, best first. It takes neither the unspecified kind nor software.
constexpr std::array kGpus{ProcessorKind::discrete, ProcessorKind::integrated, ProcessorKind::virtualGpu};

constexpr const char* kExpected = "expected auto, host, lavapipe, an index or part of a name";

std::string lower(std::string_view text)
{
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return result;
}

std::string joined(const std::vector<std::string>& reasons)
{
    std::string text;
    for (const std::string& reason : reasons) text += (text.empty() ? "" : ", ") + reason;
    return text;
}

std::string withProcessors(const std::string& sentence, const Processors& processors)
{
    std::string text = sentence;
    if (processors.empty())
        text +=
            "; no Vulkan processor was found: install the vendor's driver, or mesa-vulkan-drivers for one in software";
    for (const Processor& one : processors)
        text += "; " + std::to_string(one.index) + " is " + one.name + " (" + name(one.kind) + ", " +
                (one.refusals.empty() ? "usable" : joined(one.refusals)) + ")";
    return text + "; host is this machine's own processor";
}

[[noreturn]] void refuse(const Processors& processors, const std::string& sentence)
{
    throw ProcessorError(withProcessors(sentence, processors));
}

/// Refuses a word. Where no GPU can be used, the error names the machine as the cause, not the word.
[[noreturn]] void refuseWord(const Processors& processors, const std::string& sentence)
{
    if (std::ranges::none_of(processors, [](const Processor& one) { return one.refusals.empty(); }))
        refuse(processors, sentence);
    throw UnknownProcessor(withProcessors(sentence, processors));
}

/// Finds the first usable processor of a kind.
std::optional<std::size_t> firstOf(const Processors& processors, ProcessorKind kind)
{
    for (std::size_t n = 0; n < processors.size(); ++n)
        if (processors[n].kind == kind && processors[n].refusals.empty()) return n;
    return std::nullopt;
}

std::optional<std::size_t> withIndex(const Processors& processors, std::string_view wanted)
{
    int         index     = -1;
    const char* end       = wanted.data() + wanted.size();
    const auto [stop, ok] = std::from_chars(wanted.data(), end, index);
    if (ok != std::errc() || stop != end) return std::nullopt;
    for (std::size_t n = 0; n < processors.size(); ++n)
        if (processors[n].index == index) return n;
    constexpr int kMostIndex = 99; // a larger number may be part of a name, such as 4090
    if (index <= kMostIndex) refuseWord(processors, "there is no GPU " + std::string(wanted) + "; " + kExpected);
    return std::nullopt;
}

std::size_t withName(const Processors& processors, std::string_view wanted)
{
    const std::string        part = lower(wanted);
    std::vector<std::size_t> usable, refused;
    for (std::size_t n = 0; n < processors.size(); ++n)
        if (lower(processors[n].name).find(part) != std::string::npos)
            (processors[n].refusals.empty() ? usable : refused).push_back(n);
    const std::string quoted = std::string("'").append(wanted).append("'");
    if (usable.size() > 1) refuseWord(processors, "several GPUs are called " + quoted + "; say which by its index");
    if (usable.size() == 1) return usable.front();
    if (!refused.empty()) refuse(processors, "the GPU " + quoted + " cannot be used");
    refuseWord(processors, "no GPU is called " + quoted + "; " + kExpected);
}

} // namespace

bool isProcessorWord(std::string_view given, std::string_view word)
{
    return lower(given) == word;
}

std::optional<std::size_t> chooseProcessor(const Processors& processors, std::string_view wanted)
{
    if (isProcessorWord(wanted, kHostProcessor)) return std::nullopt;
    if (isProcessorWord(wanted, kAutoProcessor)) {
        for (const ProcessorKind kind : kGpus)
            if (const auto found = firstOf(processors, kind)) return found;
        return std::nullopt;
    }
    if (isProcessorWord(wanted, kLavapipeProcessor)) {
        if (const auto found = firstOf(processors, ProcessorKind::software)) return found;
        refuse(processors, "no GPU in software can be used (package mesa-vulkan-drivers)");
    }
    if (wanted.empty()) refuseWord(processors, std::string("an empty word names no processor; ") + kExpected);
    constexpr std::size_t kShortest = 2; // part of a name: a full stop or a space is in most of them
    const bool            hasLetter = std::ranges::any_of(wanted, [](unsigned char c) { return std::isalnum(c) != 0; });
    if (!hasLetter || (wanted.size() < kShortest && !std::isdigit(static_cast<unsigned char>(wanted.front()))))
        refuseWord(processors, "'" + std::string(wanted) + "' names no processor; " + kExpected);
    if (const auto found = withIndex(processors, wanted)) {
        if (!processors[*found].refusals.empty()) refuse(processors, "GPU " + std::string(wanted) + " cannot be used");
        return *found;
    }
    return withName(processors, wanted);
}

} // namespace palp::compute
