#include "engine/core/json_object.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/json_limits.h"
#include "engine/core/nearest_name.h"
#include "engine/core/shown_text.h"

namespace palp {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostOfValue = 200; // [bytes] of a user's own text in an error

std::string shortened(std::string_view text)
{
    return shownText(text, kMostOfValue);
}

/// Throws at the second use of a key in one object; the library alone would keep the last one. It reads by itself: a
/// callback of the library's own parser looks, at the end of each object, at all that its list holds so far, so that a
/// megabyte of small objects took it half a minute.
class RefuseTwins final : public nlohmann::json_sax<Json> {
public:
    explicit RefuseTwins(const std::string& where) : where_(where) {}

    bool start_object(std::size_t) override
    {
        open_.emplace_back();
        return true;
    }
    bool end_object() override
    {
        open_.pop_back();
        return true;
    }
    bool key(std::string& name) override
    {
        if (!open_.back().insert(name).second)
            throw Error(where_ + ": the key " +
                        shortened(Json(name).dump(-1, ' ', false, Json::error_handler_t::replace)) +
                        " is given twice in one object");
        return true;
    }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(Json::number_integer_t) override { return true; }
    bool number_unsigned(Json::number_unsigned_t) override { return true; }
    bool number_float(Json::number_float_t, const std::string&) override { return true; }
    bool string(std::string&) override { return true; }
    bool binary(Json::binary_t&) override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

private:
    const std::string&                 where_;
    std::vector<std::set<std::string>> open_;
};

/// Returns the library's own message without its tag: "parse error at line 3, column 5: ..."
std::string reasonOf(const Json::exception& failure)
{
    const std::string text = failure.what();
    const std::size_t tag  = text.find("] ");
    return shortened(tag == std::string::npos ? text : text.substr(tag + 2));
}

std::string listed(std::span<const std::string_view> names)
{
    std::string text;
    for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
}

bool isWholeNumber(const Json& value, int least, int most)
{
    return value.is_number() && value.get<double>() == std::floor(value.get<double>()) &&
           value.get<double>() >= least && value.get<double>() <= most;
}

bool isNumbers(const Json& value, std::size_t count)
{
    return value.is_array() && value.size() == count &&
           std::ranges::all_of(value, [](const Json& v) { return v.is_number(); });
}

std::string numbersInWords(std::size_t count)
{
    return "a list of " + std::to_string(count) + " numbers in SI units, such as metres, without a unit";
}

} // namespace

struct JsonObject::Node {
    std::shared_ptr<const Json> whole; ///< of which an object is a part, and no copy
    const Json&                 value;

    /// Returns the value of a key that must be there.
    [[nodiscard]] const Json& at(std::string_view key, const std::string& where) const
    {
        const auto found = value.find(std::string(key));
        if (found == value.end()) throw Error(where + ": the key " + inQuotes(key) + " is missing");
        return *found;
    }
};

JsonObject JsonObject::parse(std::string_view text, std::string where)
{
    if (const auto excess = excessOf(text))
        throw Error(where + ": line " + std::to_string(1 + std::ranges::count(text.substr(0, excess->at), '\n')) +
                    ": " + std::string(excess->what));
    { // before the values take memory too
        RefuseTwins twins(where);
        Json::sax_parse(text.begin(), text.end(), &twins, Json::input_format_t::json, true, true); // with comments
    }
    auto whole = std::make_shared<Json>();
    try {
        constexpr bool kThrow = true, kIgnoreComments = true;
        *whole = Json::parse(text.begin(), text.end(), nullptr, kThrow, kIgnoreComments);
    } catch (const Json::exception& failure) {
        throw Error(where + ": not valid JSON: " + reasonOf(failure));
    }
    if (!whole->is_object())
        throw Error(where + ": expected a JSON object {...}, found " + std::string(whole->type_name()));
    return JsonObject(std::make_shared<Node>(Node{whole, *whole}), std::move(where));
}

void JsonObject::allowOnly(std::initializer_list<std::string_view> known) const
{
    allowOnly(std::span(known.begin(), known.size()));
}

void JsonObject::allowOnly(std::span<const std::string_view> known) const
{
    for (const auto& [key, value] : node_->value.items()) {
        if (std::ranges::find(known, key) != known.end()) continue;
        const auto meant = nearestName(key, known);
        throw Error(where_ + ": unknown key " + inQuotes(key) +
                    (meant ? ", did you mean " + inQuotes(*meant) + "?" : "") + "; known keys: " + listed(known));
    }
}

JsonObject::Kind JsonObject::kind(std::string_view key) const
{
    const Json& value = node_->at(key, where_);
    if (value.is_string()) return Kind::text;
    if (value.is_number()) return Kind::number;
    if (value.is_array()) return Kind::list;
    return value.is_object() ? Kind::object : Kind::other;
}

std::string JsonObject::json(std::string_view key) const
{
    return node_->at(key, where_).dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool JsonObject::has(std::string_view key) const
{
    return node_->value.contains(std::string(key));
}

void JsonObject::refuse(std::string_view key, const std::string& expected) const
{
    throw Error(where_ + ": key " + inQuotes(key) + ": expected " + expected + ", found " + shortened(json(key)));
}

JsonObject JsonObject::object(std::string_view key) const
{
    const Json& value = node_->at(key, where_);
    if (!value.is_object()) refuse(key, "an object {...}");
    return JsonObject(std::make_shared<Node>(Node{node_->whole, value}), where_ + ": " + std::string(key));
}

std::string JsonObject::text(std::string_view key) const
{
    const Json& value = node_->at(key, where_);
    if (!value.is_string()) refuse(key, "a text in quotes");
    return value.get<std::string>();
}

double JsonObject::number(std::string_view key) const
{
    const Json& value = node_->at(key, where_);
    if (value.is_string()) refuse(key, "a number in SI units (m, N, Pa, N m) without a unit");
    if (!value.is_number()) refuse(key, "a number");
    return value.get<double>();
}

double JsonObject::positiveNumber(std::string_view key) const
{
    const double value = number(key);
    if (!(value > 0)) refuse(key, "a positive number");
    return value;
}

int JsonObject::wholeNumber(std::string_view key, int least, int most) const
{
    const Json& value = node_->at(key, where_);
    if (!isWholeNumber(value, least, most))
        refuse(key, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return int(value.get<double>());
}

std::vector<double> JsonObject::numbers(std::string_view key, std::size_t count) const
{
    const Json& value = node_->at(key, where_);
    if (!isNumbers(value, count)) refuse(key, numbersInWords(count));
    return value.get<std::vector<double>>();
}

double JsonObject::quantity(std::string_view key, const QuantityLimits& limits) const
{
    const bool   isText = kind(key) == Kind::text;
    const double value =
        isText ? parseQuantity(text(key), limits.dimension, where_ + ": key " + inQuotes(key)) : number(key);
    if (!(value >= limits.least && value <= limits.most)) refuse(key, limits.expected);
    return value;
}

glm::dvec3 JsonObject::point(std::string_view key) const
{
    if (kind(key) == Kind::text) return parsePoint(text(key), where_ + ": key " + inQuotes(key));
    const std::vector<double> at = numbers(key, 3);
    return {at[0], at[1], at[2]};
}

std::vector<JsonObject> JsonObject::objects(std::string_view key, std::size_t most, const std::string& what,
                                            const std::string& expected) const
{
    const Json& list = node_->at(key, where_);
    if (!list.is_array() || list.empty() || list.size() > most) refuse(key, expected);
    std::vector<JsonObject> all;
    for (const Json& one : list) {
        const std::string name = where_ + ": " + what + " " + std::to_string(all.size() + 1);
        if (!one.is_object())
            throw Error(name + ": expected a JSON object {...}, found " + std::string(one.type_name()));
        all.push_back(JsonObject(std::make_shared<Node>(Node{node_->whole, one}), name));
    }
    return all;
}

std::vector<std::vector<double>> JsonObject::rows(std::string_view key, std::size_t count) const
{
    const Json& value = node_->at(key, where_);
    if (!value.is_array()) refuse(key, "a list of lists of " + std::to_string(count) + " numbers");
    for (const Json& row : value)
        if (!isNumbers(row, count))
            throw Error(where_ + ": key " + inQuotes(key) + ": expected " + numbersInWords(count) +
                        " in every entry, found " +
                        shortened(row.dump(-1, ' ', false, Json::error_handler_t::replace)));
    return value.get<std::vector<std::vector<double>>>();
}

std::vector<std::string> JsonObject::texts(std::string_view key) const
{
    const Json& value = node_->at(key, where_);
    if (!value.is_array() || !std::ranges::all_of(value, [](const Json& v) { return v.is_string(); }))
        refuse(key, "a list of texts");
    return value.get<std::vector<std::string>>();
}

std::vector<std::string> JsonObject::keys() const
{
    std::vector<std::string> all;
    for (const auto& [key, value] : node_->value.items()) all.push_back(key);
    return all;
}

std::vector<int> JsonObject::wholeNumbers(std::string_view key, std::size_t count, int least, int most) const
{
    const Json& value = node_->at(key, where_);
    if (!value.is_array() || value.size() != count ||
        !std::ranges::all_of(value, [&](const Json& v) { return isWholeNumber(v, least, most); }))
        refuse(key, "a list of " + std::to_string(count) + " whole numbers from " + std::to_string(least) + " to " +
                        std::to_string(most));
    std::vector<int> list;
    for (const Json& entry : value) list.push_back(int(entry.get<double>()));
    return list;
}

} // namespace palp
