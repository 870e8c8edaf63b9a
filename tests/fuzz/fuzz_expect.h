#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"

namespace palp {

/// Stops the fuzzer, which then keeps the input.
inline void fuzzExpect(bool holds)
{
    if (!holds) std::abort();
}

/// A sentence that a terminal can show and `--json` can repeat: one line, without control characters, in UTF-8.
inline void fuzzExpectSentence(const std::string& text)
{
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]), next = static_cast<unsigned char>(text.c_str()[i + 1]);
        fuzzExpect(byte >= 0x20 && byte != 0x7f && !(byte == 0xc2 && next < 0xa0));
    }
    static_cast<void>(nlohmann::json(text).dump()); // throws where it is no UTF-8
}

/// What was refused and what was not: seeds that are all refused would test nothing behind a reader's first line.
struct FuzzVerdicts {
    std::size_t refused = 0, accepted = 0;
};
inline FuzzVerdicts fuzzVerdicts;

/// Called around each reading by whoever measures its memory; see fuzzRead.
struct FuzzReading {
    void (*begins)() = nullptr;
    void (*ends)()   = nullptr;
};
inline FuzzReading fuzzReading;

/// Reads, apart from what a harness then does with what was read. A harness that does not say so reads all the time.
template <class Read>
auto fuzzRead(const Read& read)
{
    struct Reading {
        Reading()
        {
            if (fuzzReading.begins) fuzzReading.begins();
        }
        ~Reading()
        {
            if (fuzzReading.ends) fuzzReading.ends();
        }
    } const reading;
    return read();
}

/// Does what may be refused: an Error is a right answer if it is such a sentence, and nothing else may come out.
template <class Act>
void fuzzRefusals(const Act& act)
{
    try {
        act();
        ++fuzzVerdicts.accepted;
    } catch (const Error& error) {
        ++fuzzVerdicts.refused;
        fuzzExpectSentence(error.what());
    }
}

} // namespace palp
