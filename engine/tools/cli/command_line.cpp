#include "engine/tools/cli/commands.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/quantity.h"

namespace palp {

void warn(const std::vector<std::string>& sentences)
{
    for (const std::string& sentence : sentences) std::cerr << "palpate: warning: " << sentence << "\n";
}

void warn(const std::vector<std::string>& sentences, std::vector<std::string>& said)
{
    warn(sentences);
    said.insert(said.end(), sentences.begin(), sentences.end());
}

void say(const std::vector<std::string>& sentences)
{
    for (const std::string& sentence : sentences) std::cerr << "palpate: " << sentence << "\n";
}

nlohmann::ordered_json orNull(const std::string& text)
{
    return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

void demandSvg(const std::string& option, const std::string& file)
{
    if (file.empty()) return;
    if (std::filesystem::path(file).extension() != ".svg")
        throw Error(option + ": expected a file that ends in .svg, found \"" + file + "\"");
    expectWritable(file);
}

void demandFolder(const std::string& option, const std::string& folder)
{
    if (folder == "-")
        throw Error(option + ": expected a folder, found \"-\", which stands for standard output; name a folder");
    if (!folder.empty()) expectWritableFolder(folder);
}

void demandOwner(const CLI::App& command, const std::string& owner, std::initializer_list<const char*> options)
{
    if (command.get_option(owner)->count() > 0) return;
    for (const std::string option : options)
        if (command.get_option(option)->count() > 0)
            throw Error(option + " belongs to " + owner + ", which is not given; add " + owner + " or omit " + option);
}

void allowOnlyWith(const CLI::App& command, const std::string& option, const std::vector<std::string>& allowed)
{
    if (command.get_option(option)->count() == 0) return;
    for (const CLI::Option* other : command.get_options()) {
        const std::string name = other->get_name();
        if (other->count() > 0 && name != option && std::ranges::find(allowed, name) == allowed.end())
            throw Error(name + " has no effect with " + option + "; omit one of the two");
    }
}

double forceOf(const std::string& text)
{
    constexpr double kMost = 1e6; // [N] far beyond what a hand can feel, and far below what could overflow a result
    const double     force = parseQuantity(text, Dimension::force, "--force");
    if (force >= 0 && force <= kMost) return force;
    throw Error("--force: expected a force from 0 to 1e6 N, found \"" + text + "\"");
}

std::pair<int, int> pixelsOf(const std::string& text, int least, int most)
{
    int        width = 0, height = 0, end = 0;
    const bool read =
        std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &end) == 2 && std::size_t(end) == text.size();
    if (read && std::min(width, height) >= least && std::max(width, height) <= most) return {width, height};
    throw Error("--size: expected WIDTHxHEIGHT of " + std::to_string(least) + " to " + std::to_string(most) +
                " px each, such as 1280x720, found \"" + text + "\"");
}

std::string commandOf(const CLI::App& command)
{
    const auto quoted = [](const std::string& text) {
        constexpr const char* kPlain = // to every shell
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./:=,@%+-";
        if (text.find_first_not_of(kPlain) == std::string::npos) return text;
        std::string result = "'";
        for (const char c : text) {
            if (c == '\'')
                result.append("'\\''");
            else
                result.push_back(c);
        }
        result.push_back('\'');
        return result;
    };
    std::string line = "palpate " + command.get_name();
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0) continue;
        if (option->get_expected_max() > 1 && !option->get_allow_extra_args()) { // repeated, once for each value
            for (const std::string& value : option->results())
                line.append(" --").append(option->get_lnames().front()).append(" ").append(quoted(value));
            continue;
        }
        if (!option->get_positional()) line.append(" --").append(option->get_lnames().front());
        if (option->get_items_expected_max() == 0) continue; // a flag
        for (const std::string& value : option->results()) line.append(" ").append(quoted(value));
    }
    return line;
}

} // namespace palp
