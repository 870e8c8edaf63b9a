#include "engine/compute/context.h"

#include <algorithm>
#include <optional>

#include "engine/compute/backend.h"
#include "engine/compute/detail/host_context.h"
#include "engine/compute/vulkan_handles.h"
#include "engine/core/contract.h"

namespace palp::compute {
namespace {

using Handles = std::unique_ptr<Context::Handles>;

std::vector<Processor> descriptionsOf(const std::vector<Candidate>& candidates)
{
    std::vector<Processor> list;
    for (const Candidate& candidate : candidates) list.push_back(candidate.description);
    return list;
}

Handles openHost(const ContextSettings& settings)
{
    if (settings.validation != Validation::off)
        throw ProcessorError(
            "validation was asked for, and the host has no shaders; name a Vulkan processor, such as lavapipe");
    return std::make_unique<HostContext>();
}

Handles openWanted(const ContextSettings& settings)
{
    auto                         instance = std::make_unique<Instance>(settings.validation);
    const std::vector<Candidate> found    = candidates(*instance);
    if (const auto place = chooseProcessor(descriptionsOf(found), settings.processor))
        return std::make_unique<VulkanContext>(instance, found[*place], settings.patience);
    return openHost(settings);
}

/// Skips broken GPUs for the next best one, and in the end for the host.
Handles openBest(const ContextSettings& settings)
{
    Handles     opened;
    std::string note;
    try {
        auto                         instance = std::make_unique<Instance>(Validation::off);
        const std::vector<Candidate> found    = candidates(*instance);
        std::vector<Processor>       list     = descriptionsOf(found);
        for (auto place = chooseProcessor(list, kAutoProcessor); place && !opened;
             place      = chooseProcessor(list, kAutoProcessor)) {
            try {
                opened = std::make_unique<VulkanContext>(instance, found[*place], settings.patience);
            } catch (const Error& error) {
                list[*place].refusals.emplace_back(error.what());
                note += (note.empty() ? "" : "; ") + std::string(error.what());
            }
        }
    } catch (const ProcessorError& error) { // not even listing works
        note = error.what();
    }
    if (!opened) opened = openHost(settings);
    opened->note = note;
    return opened;
}

/// Finds the first usable one of these kinds, in their order.
std::optional<std::size_t> bestToDraw(const std::vector<Processor>& list)
{
    using enum ProcessorKind;
    for (const ProcessorKind kind : {discrete, integrated, virtualGpu, software})
        for (std::size_t n = 0; n < list.size(); ++n)
            if (list[n].kind == kind && list[n].refusals.empty()) return n;
    return std::nullopt;
}

[[noreturn]] void refuseToDraw(const std::vector<Processor>& list)
{
    std::string sentence = "no Vulkan processor can draw";
    if (list.empty())
        sentence += ", for none was found: install the vendor's driver, or mesa-vulkan-drivers for one in software";
    for (const Processor& one : list)
        sentence += "\n  " + std::to_string(one.index) + "  " + one.name + ": " +
                    (one.refusals.empty() ? "of a kind that is not taken by itself" : one.refusals.front());
    throw ProcessorError(sentence);
}

Handles openToDraw(const ContextSettings& settings)
{
    if (isProcessorWord(settings.processor, kHostProcessor))
        throw ProcessorError("the host computes and cannot draw; name a Vulkan processor, such as lavapipe");
    auto                         instance = std::make_unique<Instance>(settings.validation, settings.windowExtensions);
    const std::vector<Candidate> found    = candidates(*instance);
    std::vector<Processor>       list     = descriptionsOf(found);
    for (std::size_t n = 0; n < list.size(); ++n) {
        if (!found[n].drawFamily) list[n].refusals.emplace_back("it has no queue that draws");
        if (!found[n].largePoints)
            list[n].refusals.emplace_back("it draws no points larger than a pixel (largePoints)");
    }
    const auto open = [&](std::size_t n) {
        return std::make_unique<VulkanContext>(instance, found[n], settings.patience, settings.purpose);
    };
    if (!isProcessorWord(settings.processor, kAutoProcessor))
        return open(chooseProcessor(list, settings.processor).value());
    std::string note;
    while (const auto place = bestToDraw(list)) try {
            Handles opened = open(*place);
            opened->note   = note;
            return opened;
        } catch (const Error& error) {
            list[*place].refusals.emplace_back(error.what());
            note += (note.empty() ? "" : "; ") + std::string(error.what());
        }
    refuseToDraw(list);
}

Handles openAny(const ContextSettings& settings)
{
    if (settings.purpose != Purpose::compute) return openToDraw(settings);
    if (isProcessorWord(settings.processor, kHostProcessor)) return openHost(settings); // loads no driver
    const bool best = isProcessorWord(settings.processor, kAutoProcessor) && settings.validation == Validation::off;
    return best ? openBest(settings) : openWanted(settings);
}

template <class Number>
void lower(Number& limit, Number most)
{
    if (most > 0) limit = std::min(limit, most);
}

Handles open(const ContextSettings& settings)
{
    Handles opened = openAny(settings);
    lower(opened->limits.buffer, settings.most.buffer);
    lower(opened->limits.invocations, settings.most.invocations);
    lower(opened->limits.buffers, settings.most.buffers);
    lower(opened->limits.sharedMemory, settings.most.sharedMemory);
    opened->description.float64 = opened->description.float64 && settings.float64;
    return opened;
}

} // namespace

Context::Context(const ContextSettings& settings) : handles_(open(settings)) {}
Context::~Context()                             = default;
Context::Context(Context&&) noexcept            = default;
Context& Context::operator=(Context&&) noexcept = default;

void Context::run(CommandList& list)
{
    CommandList* const only = &list;
    run({&only, 1});
}

void Context::run(std::span<CommandList* const> lists)
{
    for (const CommandList* list : lists) {
        PALP_EXPECT(list->ended(), "a command list runs after end()");
        PALP_EXPECT(&list->handles().context == handles_.get(), "a command list runs on the context it was made from");
    }
    handles_->run(lists);
    for (const CommandList* list : lists) list->handles().ran = true;
}

std::vector<std::string> Context::takeMessages()
{
    return handles_->takeMessages();
}

const Processor& Context::processor() const noexcept
{
    return handles_->description;
}

const std::string& Context::note() const noexcept
{
    return handles_->note;
}

std::size_t Context::allocatedBytes() const noexcept
{
    return handles_->allocated;
}

const Limits& Context::limits() const noexcept
{
    return handles_->limits;
}

bool Context::bitExact() const noexcept
{
    return handles_->bitExact;
}

} // namespace palp::compute
