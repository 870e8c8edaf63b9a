#pragma once
#include "engine/core/contract.h"
#include "engine/core/enum_names.h"
#include "engine/core/shown_text.h"

namespace palp {

/// Returns the value that an option's word names.
/// \throws Error with the words that the option takes
template <NamedEnum Enum>
[[nodiscard]] Enum optionNamed(const std::string& option, const std::string& word)
{
    if (const auto value = valueNamed<Enum>(word)) return *value;
    throw Error(option + ": expected " + wordsOf<Enum>() + ", found " + inQuotes(word));
}

} // namespace palp
