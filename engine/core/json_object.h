#pragma once
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/quantity.h"

namespace palp {

/// One JSON object given by a user, read key by key. Every error names the place, the key, what was expected and what
/// was found. Comments are allowed; a key given twice is refused.
class JsonObject {
public:
    /// Parses a text.
    /// \param where  name of the text that begins every error, such as a file's path
    /// \throws Error with line and column if the text is not JSON, not an object, or too much (see excessOf)
    static JsonObject parse(std::string_view text, std::string where);

    enum class Kind { text, number, list, object, other };

    /// Checks that the object has no other keys.
    /// \throws Error naming the first key that is not `known`, the one that was likely meant, and the known ones
    void allowOnly(std::initializer_list<std::string_view> known) const;
    void allowOnly(std::span<const std::string_view> known) const;

    [[nodiscard]] bool                     has(std::string_view key) const;
    [[nodiscard]] std::vector<std::string> keys() const;

    // All functions below throw Error if the key is missing or its value has another type.
    [[nodiscard]] Kind                     kind(std::string_view key) const;
    [[nodiscard]] std::string              json(std::string_view key) const; ///< the value as JSON on one line
    [[nodiscard]] JsonObject               object(std::string_view key) const;
    [[nodiscard]] std::string              text(std::string_view key) const;
    [[nodiscard]] double                   number(std::string_view key) const;
    [[nodiscard]] double                   positiveNumber(std::string_view key) const;
    [[nodiscard]] int                      wholeNumber(std::string_view key, int least, int most) const;
    [[nodiscard]] std::vector<double>      numbers(std::string_view key, std::size_t count) const;
    [[nodiscard]] std::vector<std::string> texts(std::string_view key) const; ///< a list of them
    /// Returns a list of lists of `count` numbers each.
    [[nodiscard]] std::vector<std::vector<double>> rows(std::string_view key, std::size_t count) const;
    [[nodiscard]] std::vector<int> wholeNumbers(std::string_view key, std::size_t count, int least, int most) const;

    /// The numbers with a unit that a key may have, in SI units.
    struct QuantityLimits {
        Dimension   dimension;
        double      least, most;
        const char* expected; ///< "a length from 1e-5 to 1 m, such as 4 mm"
    };
    /// Returns a plain number in SI units, or a text with a unit.
    [[nodiscard]] double quantity(std::string_view key, const QuantityLimits& limits) const;
    /// Returns a place: a text such as "10mm,0,2cm", or three numbers [m].
    [[nodiscard]] glm::dvec3 point(std::string_view key) const;
    /// Returns a list of objects, each called `what` and its number in errors.
    /// \param expected  the list in words, "a list of 1 to 64 nodules"
    [[nodiscard]] std::vector<JsonObject> objects(std::string_view key, std::size_t most, const std::string& what,
                                                  const std::string& expected) const;

    /// Refuses the value of a key that is there.
    /// \throws Error "WHERE: key "KEY": expected EXPECTED, found FOUND", always
    [[noreturn]] void refuse(std::string_view key, const std::string& expected) const;

    [[nodiscard]] const std::string& where() const noexcept { return where_; }

private:
    struct Node;
    JsonObject(std::shared_ptr<const Node> node, std::string where) : node_(std::move(node)), where_(std::move(where))
    {
    }

    std::shared_ptr<const Node> node_;
    std::string                 where_;
};

} // namespace palp
