#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/cloud/material_library.h"
#include "engine/core/enum_names.h"
#include "engine/core/quantity.h"
#include "engine/session/scene.h"

namespace palp {

struct WrittenValue;

/// The values that a number or count may have, in SI units.
struct KeyBounds {
    double least = 0, most = 0;
    bool   open       = false; ///< the bounds themselves are refused
    int    multipleOf = 1;     ///< of counts
};

/// The form in which a panel shows a key: a number as a slider, a word as a list.
struct KeyControl {
    enum class Panel { material, patch, servo };
    Panel       panel = Panel::material;
    const char* label = "";

    // The rest applies to sliders.
    const char* unit    = "";        ///< in which the number is shown and sent; empty for none
    double      perUnit = 1;         ///< SI units in one of these
    double      least = 0, most = 0; ///< of the slider, in `unit`: narrower than what a scene takes
    bool        logarithmic = false;
    int         decimals    = 0;
    double      step        = 0; ///< values are multiples of it, in `unit`; 0: any
};

/// One value of a scene, under the same name in a file ("max_force"), in the environment (PALPATE_MAX_FORCE) and as a
/// flag (--max-force). Readers, help, schema, panels and tables of the pages all come from here.
///
/// Quantities may be plain numbers in `unit` or texts with a unit of the same dimension ("4 mm").
struct SceneKey {
    /// The commands that use the key; a later group is for commands that take the earlier ones too.
    enum class Group {
        object, ///< the touched object, and how its file is read
        touch,  ///< where it is touched, how it bends, how it is felt
        session ///< the session from tick to tick
    };
    enum class Kind { text, word, number, count, yesNo, point, range, object, objects }; ///< the last: one or a list
    enum class For { anyCloud, file, sample }; ///< the clouds that the key can be about

    std::string_view name, help;
    Group            group = Group::object;
    Kind             kind  = Kind::text;
    std::string_view unit{}; ///< of plain numbers; "1" for a ratio or a count, empty for names and texts
    std::string_view form{}; ///< the expected form, where the kind does not define it, such as "a direction [x, y, z]"
    std::string_view example{};
    Dimension        dimension = Dimension::none; ///< of a number
    std::optional<KeyBounds>  bounds{};
    std::vector<std::string>  words{};  ///< all that are accepted, of Kind::word; of a count the numbers
    std::string               schema{}; ///< JSON Schema of the value, where the kind does not define it
    For                       cloud        = For::anyCloud;
    bool                      decidesCloud = false; ///< another value makes another cloud
    std::optional<KeyControl> control{};            ///< empty: no panel shows it

    void (*read)(Scene&, const WrittenValue&) = nullptr;
    std::string (*write)(const Scene&)        = nullptr; ///< as JSON; empty: the scene has no value
    double (*number)(const Scene&)            = nullptr; ///< of a number or a count with a control [unit]

    /// Returns what is accepted, as complaints, help and tips state it: "a length from 1e-6 to 1 m, such as 4 mm".
    [[nodiscard]] std::string expected() const;
};

/// A value as it was written. Numbers, lists and objects of a file arrive in the spelling of a flag, so that each key
/// has one reader.
struct WrittenValue {
    const SceneKey&    key;
    const std::string& text;
    const std::string& what;                     ///< opens complaints: "skin.json: key \"thickness\"", "--thickness"
    double             metresPerPlainNumber = 1; ///< of lengths without a unit

    /// Refuses the value.
    /// \throws Error always: what was expected and found
    [[noreturn]] void refuse(const std::string& hint = {}) const;

    // All below throw Error unless the text is one and lies within the key's bounds.
    [[nodiscard]] double        number() const; ///< SI
    [[nodiscard]] std::uint64_t count() const;
    [[nodiscard]] bool          yesNo() const;
    [[nodiscard]] std::string   word() const; ///< one of the key's words

    template <NamedEnum Enum>
    [[nodiscard]] Enum value() const
    {
        return *valueNamed<Enum>(word());
    }
};

/// Returns all keys of the library, in the order in which they are read, listed and printed.
[[nodiscard]] const std::vector<SceneKey>& sceneKeys();

/// Returns those, and then the keys that a tool has added.
[[nodiscard]] std::vector<const SceneKey*> sceneKeysWith(const std::vector<SceneKey>* toolKeys);

/// Returns the key of that name.
/// \pre there is one
[[nodiscard]] const SceneKey& sceneKey(std::string_view name);

/// Returns today's name of a key that was called `name` until recordings had format 2; empty for any other name.
[[nodiscard]] std::optional<std::string_view> keyNamedOnce(std::string_view name) noexcept;

/// Returns the names of a key's flag, "--max-force", and of its variable, "PALPATE_MAX_FORCE".
[[nodiscard]] std::string flagOf(std::string_view key);
[[nodiscard]] std::string variableOf(std::string_view key);

/// Returns the values that a preset sets, in the spelling of flags. `palpate` leaves the foundation as it is.
[[nodiscard]] std::map<std::string, std::string, std::less<>> presetValues(Preset preset);

/// Returns the values that a material sets, as far as they are known.
[[nodiscard]] std::map<std::string, std::string, std::less<>> materialValues(const KnownMaterial& material);

/// Returns the JSON Schema of scene files, and the keys as a table in Markdown.
[[nodiscard]] std::string sceneSchema(const std::vector<SceneKey>* toolKeys = nullptr);
[[nodiscard]] std::string sceneKeyTable(const std::vector<SceneKey>* toolKeys = nullptr);

/// Returns "1e-6" or "0.25": the fewest digits that bring the number back, without zeros in the exponent.
[[nodiscard]] std::string plainNumber(double value);

/// Returns a text as JSON.
[[nodiscard]] std::string quotedJson(std::string_view text);

/// Returns the names of an enumeration, as `SceneKey::words`.
template <NamedEnum Enum>
[[nodiscard]] std::vector<std::string> namesIn()
{
    std::vector<std::string> names;
    for (const auto& entry : namesOf(Enum{})) names.emplace_back(entry.name);
    return names;
}

/// Completes a key whose value is a number at `field(scene)`.
template <class Field>
[[nodiscard]] SceneKey numberKey(SceneKey key, Field)
{
    key.kind   = SceneKey::Kind::number;
    key.read   = [](Scene& s, const WrittenValue& v) { Field{}(s) = v.number(); };
    key.write  = [](const Scene& s) { return plainNumber(Field{}(s)); };
    key.number = [](const Scene& s) { return double(Field{}(s)); };
    return key;
}

/// Completes a key whose value is a whole number.
template <class Field>
[[nodiscard]] SceneKey countKey(SceneKey key, Field)
{
    key.kind = SceneKey::Kind::count;
    key.unit = "1";
    key.read = [](Scene& s, const WrittenValue& v) {
        Field{}(s) = std::remove_reference_t<decltype(Field{}(s))>(v.count());
    };
    key.write  = [](const Scene& s) { return std::to_string(Field{}(s)); };
    key.number = [](const Scene& s) { return double(Field{}(s)); };
    return key;
}

/// Completes a key whose value is one of the names of an enumeration.
template <class Field>
[[nodiscard]] SceneKey wordKey(SceneKey key, Field)
{
    using Enum = std::remove_reference_t<decltype(Field{}(std::declval<Scene&>()))>;
    key.kind   = SceneKey::Kind::word;
    key.words  = namesIn<Enum>();
    key.read   = [](Scene& s, const WrittenValue& v) { Field{}(s) = v.template value<Enum>(); };
    key.write  = [](const Scene& s) { return quotedJson(name(Field{}(s))); };
    return key;
}

} // namespace palp
