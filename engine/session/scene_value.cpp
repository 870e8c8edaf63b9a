#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include <nlohmann/json.hpp>

#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"
#include "engine/core/nearest_name.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"
#include "engine/session/scene_keys.h"

// Values of scene keys, from texts and to texts.

namespace palp {
namespace {

std::string listed(const std::vector<std::string>& words)
{
    std::string all;
    for (std::size_t n = 0; n < words.size(); ++n)
        all += (n == 0 ? "" : n + 1 == words.size() ? " or " : ", ") + words[n];
    return all;
}

const char* nounOf(Dimension dimension)
{
    switch (dimension) {
    case Dimension::length:
        return "a length";
    case Dimension::force:
        return "a force";
    default:
        return "a number";
    }
}

} // namespace

std::string plainNumber(double value)
{
    std::array<char, 32> digits{};
    std::string          text(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
    if (const auto at = text.find("e-0"); at != std::string::npos) text.erase(at + 2, 1);
    if (const auto at = text.find("e+"); at != std::string::npos) text.erase(at + 1, text[at + 2] == '0' ? 2 : 1);
    return text;
}

std::string quotedJson(std::string_view text)
{
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string SceneKey::expected() const
{
    if (!form.empty()) return std::string(form);
    if (!words.empty()) return listed(words);
    if (kind == Kind::yesNo) return "true or false";
    if (!bounds) return "a text";
    const std::string least = plainNumber(bounds->least), most = plainNumber(bounds->most);
    if (kind == Kind::count)
        return (bounds->multipleOf == 2 ? "an even number from " : "a whole number from ") +
               std::to_string(std::int64_t(bounds->least)) + " to " + std::to_string(std::int64_t(bounds->most));
    std::string sentence = nounOf(dimension);
    sentence += bounds->open ? " above " + least + " and below " + most : " from " + least + " to " + most;
    if (unit != "1" && !unit.empty()) sentence += " " + std::string(unit);
    return sentence + (example.empty() ? "" : ", such as " + std::string(example));
}

void WrittenValue::refuse(const std::string& hint) const
{
    constexpr std::size_t kMost = 200; // [bytes] of a user's own text in a complaint
    throw Error(what + ": expected " + key.expected() + ", found \"" + shownText(text, kMost) + "\"" + hint);
}

double WrittenValue::number() const
{
    std::string_view plain = text; // without a dimension of its own a number may still carry the key's unit: "60 Hz"
    if (key.dimension == Dimension::none && key.unit != "1" && plain.ends_with(key.unit))
        plain.remove_suffix(key.unit.size());
    const double perPlain                      = key.dimension == Dimension::length ? metresPerPlainNumber : 1;
    const double value                         = parseQuantity(plain, key.dimension, what, perPlain);
    const auto [least, most, open, multipleOf] = *key.bounds;
    if (open ? !(value > least && value < most) : !(value >= least && value <= most))
        refuse(perPlain == 1 || std::isalpha(static_cast<unsigned char>(text.back())) != 0
                   ? ""
                   : ", which the length unit makes " + plainNumber(value) + " m");
    return value;
}

std::uint64_t WrittenValue::count() const
{
    const auto value = parseCount(text);
    if (!value || double(*value) < key.bounds->least || double(*value) > key.bounds->most) refuse();
    if (*value % std::uint64_t(key.bounds->multipleOf) != 0) refuse();
    if (!key.words.empty() && std::ranges::find(key.words, std::to_string(*value)) == key.words.end()) refuse();
    return *value;
}

bool WrittenValue::yesNo() const
{
    if (text != "true" && text != "false") refuse();
    return text == "true";
}

std::string WrittenValue::word() const
{
    if (const std::string word = unitInAscii(text); std::ranges::find(key.words, word) != key.words.end()) return word;
    const std::vector<std::string_view> words(key.words.begin(), key.words.end());
    const auto                          meant = nearestName(text, words);
    refuse(meant ? "; did you mean \"" + std::string(*meant) + "\"?" : "");
}

} // namespace palp
