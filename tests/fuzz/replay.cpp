#include <malloc.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

// palp_fuzz_replay SEEDS...: gives each harness the seeds of its folder in SEEDS, whole, cut short, and with single
// bytes changed. It needs no clang, so that every machine runs it. It also measures memory: a reader that believes a
// header asks for more than its input can hold.
//
// palp_fuzz_replay --linear SHORT LONG: compares the time that each harness takes for an input and for one with kLonger
// times as many records, and how it ends, for each file of make_long.py.
//
// palp_fuzz_replay --few SEEDS...: the same with few damages, for valgrind.

#include "tests/fuzz/fuzz_expect.h"
#include "tests/support/memory_use.h"

#define PALPATE_HARNESS(name) extern "C" int fuzz_##name(const std::uint8_t*, std::size_t);
#include "fuzz_harnesses.def"
#undef PALPATE_HARNESS

namespace {

using Harness = int (*)(const std::uint8_t*, std::size_t);
struct Named {
    const char* name;
    Harness     run;
};
constexpr Named kHarnesses[] = {
#define PALPATE_HARNESS(name) {#name, &fuzz_##name},
#include "fuzz_harnesses.def"
#undef PALPATE_HARNESS
};

/// [bytes] of memory that reading takes for each byte of an input. A point takes 32 in memory, and 16 more while equal
/// places are looked for; the shortest row of text that can be told from thousands of others, "12 34 5\n", has 8 bytes.
constexpr std::size_t kMostPerByte = 10;

/// [bytes] beside it: buffers of streams, the table of keys, zlib's window.
constexpr std::size_t kMostBeside = std::size_t(512) << 10;

/// What reading takes at most.
struct Memory {
    std::size_t perByte = kMostPerByte;
    std::size_t beside  = kMostBeside; ///< [bytes]
};

/// What takes more, for a reason.
struct Exception {
    std::string_view harness, file; ///< empty: any
    Memory           memory;
};
constexpr std::size_t kMiB          = std::size_t(1) << 20;
constexpr Exception   kExceptions[] = {
      // Its objects have plates of 8 cells, a solver and a session with its thread.
    {"capi", "", {kMostPerByte, 2 * kMiB}},
    // JSON takes 8 times its size and 8 MiB; more is refused, see json_limits.h. A part of a scene or a plan is read
    // twice.
    {"", "wide", {kMostPerByte, 8 * kMiB}},
    {"haply", "long", {kMostPerByte, 8 * kMiB}},
    {"recording", "keys", {kMostPerByte, 8 * kMiB}},
    {"scene", "below", {kMostPerByte, 8 * kMiB}},
    {"plan", "tasks", {kMostPerByte, 8 * kMiB}},
    {"window", "long", {kMostPerByte, 8 * kMiB}},
    // A probe takes 600, and 10 000 are the most.
    {"probes", "single", {kMostPerByte, 6 * kMiB}},
    // A trial takes 430 and at least 38 in the file, and 100 000 are the most.
    {"trials", "long", {kMostPerByte, 5 * kMiB}},
    {"trials", "short", {kMostPerByte, 5 * kMiB}},
    {"trials", "conditions", {kMostPerByte, 5 * kMiB}},
    // A triangle takes 12; a corner may have a number of one byte.
    {"ply", "bits", {14, kMiB}},
};

Memory memoryOf(std::string_view harness, std::string_view file)
{
    for (const Exception& one : kExceptions)
        if ((one.harness.empty() || one.harness == harness) && (one.file.empty() || one.file == file))
            return one.memory;
    return {};
}

std::size_t atBegin = 0, mostRead = 0; // [bytes] live as the reading began; the most that one of this input took

const char*                      current = "";
const std::vector<std::uint8_t>* input   = nullptr;

/// Keeps the input at which the program ends; libFuzzer's way of telling.
[[noreturn]] void keep(int signal)
{
    static constexpr char kFile[] = "fuzz-replay-crash";
    if (std::FILE* const file = std::fopen(kFile, "wb")) {
        std::fwrite(input->data(), 1, input->size(), file);
        std::fclose(file);
    }
    std::fprintf(stderr, "%s: FAILED with signal %d, the input is kept as %s\n", current, signal, kFile);
    std::_Exit(1);
}

class Replay {
public:
    /// \param file  name of the inputs, for their exceptions
    explicit Replay(const Named& harness, std::string_view file = "")
        : harness_(harness), memory_(memoryOf(harness.name, file))
    {
        current = harness.name;
    }

    void whole(const std::vector<std::uint8_t>& bytes)
    {
        ++inputs_;
        input                    = &bytes;
        const std::size_t before = palp::memoryNow();
        palp::forgetMostMemory();
        mostRead = 0;
        harness_.run(bytes.data(), bytes.size());
        const std::size_t taken = mostRead > 0 ? mostRead : palp::mostMemory() - before;
        most_                   = std::max(most_, taken);
        if (taken > memory_.beside + memory_.perByte * bytes.size()) {
            std::fprintf(stderr, "%zu bytes of memory for an input of %zu\n", taken, bytes.size());
            std::abort();
        }
    }

    /// The input cut short and with bytes changed, at places that are even over it.
    void damaged(std::vector<std::uint8_t> bytes, std::size_t places)
    {
        const std::size_t step = bytes.size() / places + 1;
        for (std::size_t at = 0; at < bytes.size(); at += step) {
            whole({bytes.begin(), bytes.begin() + std::ptrdiff_t(at)});
            for (const int change : {0x01, 0x80, 0xFF}) {
                bytes[at] = std::uint8_t(bytes[at] ^ change);
                whole(bytes);
                bytes[at] = std::uint8_t(bytes[at] ^ change);
            }
        }
    }

    [[nodiscard]] std::size_t inputs() const noexcept { return inputs_; }
    [[nodiscard]] std::size_t most() const noexcept { return most_; }

private:
    const Named& harness_;
    Memory       memory_;
    std::size_t  inputs_ = 0, most_ = 0;
};

constexpr double kLonger = 16; ///< records of a long input over those of a short one [1]
/// What a reader may take for the long one, over kLonger times what it takes for the short one [1]: a short input fits
/// into the caches, a long one does not. One whose time grows with the square would take 16 times as long, not 3.
constexpr double kMostOver = 3;
/// A harness that takes less than this for the long input over the short one has refused it, or not read it to its end
/// [1].
constexpr double kRead = 2;

/// Returns the least processor time of several runs over the bytes [s].
double secondsOf(Replay& replay, const std::vector<std::uint8_t>& bytes, int runs)
{
    double least = std::numeric_limits<double>::infinity();
    for (int n = 0; n < runs; ++n) {
        const std::clock_t began = std::clock();
        replay.whole(bytes);
        least = std::min(least, double(std::clock() - began) / CLOCKS_PER_SEC);
    }
    return least;
}

std::vector<std::uint8_t> contentsOf(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// What a harness does with a file of make_long.py.
enum class Verdict { accepted, refused, either };

Verdict verdictOn(const std::string& file)
{
    if (file == "long") return Verdict::accepted;
    for (const char* const once :
         {"deep", "wide", "markers", "parts", "tasks", "lines"}) // what took a time is refused at once now
        if (file == once) return Verdict::refused;
    return file == "same" || file == "bits" || file == "conditions" || file == "short" || file == "elements" ||
                   file == "faces" || file == "digits" || file == "cap"
               ? Verdict::accepted
               : Verdict::either; // "columns", "keys" and others are refused in the end, once they are read
}

/// Returns what is wrong with how a harness took a long file and the short one of the same name; empty if nothing is.
std::string wrongWith(const Named& harness, const std::filesystem::path& few, const std::filesystem::path& many)
{
    const std::string file  = many.filename();
    const auto        small = contentsOf(few), large = contentsOf(many);
    Replay            replay(harness, file);
    const double      brief   = secondsOf(replay, small, 7);
    double            lasting = secondsOf(replay, large, 3);
    // What else the machine does lengthens runs side by side: what takes too long by itself does so again and again.
    for (int again = 0; again < 5 && !(lasting < kMostOver * kLonger * brief); ++again)
        lasting = std::min(lasting, secondsOf(replay, large, 3));
    palp::fuzzVerdicts = {};
    replay.whole(large);
    const auto [refused, accepted] = palp::fuzzVerdicts;
    std::printf("%-10s %-10s %8zu bytes in %9.3f ms, %8zu in %9.3f ms: %5.1f times, at most %5zu KiB of memory, %.1f "
                "for a byte\n",
                harness.name, file.c_str(), small.size(), 1e3 * brief, large.size(), 1e3 * lasting, lasting / brief,
                replay.most() >> 10U, double(replay.most()) / double(large.size()));
    const Verdict verdict = verdictOn(file);
    if (verdict == Verdict::refused && (refused == 0 || accepted > 0)) return "it was accepted";
    if (verdict == Verdict::accepted && accepted == 0 && refused > 0) return "it was refused";
    // A window's memory that cannot be read counts as none: one that is nested too deep ends at once, unrefused.
    const bool endsEarly = file == "nested";
    if (verdict != Verdict::refused && !endsEarly && !(lasting > kRead * brief)) return "it was not read";
    if (!(lasting < kMostOver * kLonger * brief)) return "more than in proportion";
    return "";
}

/// Returns whether every harness has a long file, and takes for each of its files what is in proportion to it.
bool isLinear(const char* shorts, const char* longs)
{
    bool good = true;
    for (const Named& harness : kHarnesses) {
        bool hasLong = false;
        for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(longs) / harness.name)) {
            const std::string wrong =
                wrongWith(harness, std::filesystem::path(shorts) / harness.name / file.path().filename(), file.path());
            if (!wrong.empty())
                std::printf("%s, %s: FAILED: %s\n", harness.name, file.path().filename().c_str(), wrong.c_str());
            good    = good && wrong.empty();
            hasLong = hasLong || file.path().filename() == "long";
        }
        if (!hasLong) std::printf("%s: FAILED: make_long.py has no file for it\n", harness.name);
        good = good && hasLong;
    }
    return good;
}

} // namespace

int main(int count, char** arguments)
{
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, keep);
    palp::fuzzReading = {[] {
                             palp::forgetMostMemory();
                             atBegin = palp::memoryNow();
                         },
                         [] { mostRead = std::max(mostRead, palp::mostMemory() - atBegin); }};
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
#if defined(__GLIBC__)
    // Memory that is given back is kept: what is timed is the readers, and not how long a machine takes to hand out empty
    // pages, which some do so slowly that long inputs took thrice their share.
    constexpr int kAll = 1 << 30;
    mallopt(M_MMAP_THRESHOLD, kAll);
    mallopt(M_TRIM_THRESHOLD, kAll);
#endif
    if (count == 4 && std::string(arguments[1]) == "--linear") return isLinear(arguments[2], arguments[3]) ? 0 : 1;
    const bool few    = count > 1 && std::string(arguments[1]) == "--few";
    bool       failed = false;
    for (const Named& harness : kHarnesses) {
        Replay             replay(harness);
        std::size_t        seeds = 0;
        palp::FuzzVerdicts wholes; // on seeds as they are
        for (int n = few ? 2 : 1; n < count; ++n) {
            const auto folder = std::filesystem::path(arguments[n]) / harness.name;
            if (!std::filesystem::is_directory(folder)) continue;
            for (const auto& file : std::filesystem::directory_iterator(folder)) {
                const auto bytes   = contentsOf(file.path());
                palp::fuzzVerdicts = {};
                replay.whole(bytes);
                wholes.accepted += palp::fuzzVerdicts.accepted;
                wholes.refused += palp::fuzzVerdicts.refused;
                replay.damaged(bytes, few ? 40 : 250);
                ++seeds;
            }
        }
        std::printf("%-10s %3zu seeds, %6zu inputs, at most %4zu KiB of memory\n", harness.name, seeds, replay.inputs(),
                    replay.most() >> 10U);
        if (seeds == 0) {
            std::fprintf(stderr, "%s: FAILED: there is no seed for it\n", harness.name);
            return 1;
        }
        if (wholes.accepted == 0 && wholes.refused > 0) {
            std::fprintf(stderr, "%s: FAILED: every seed is refused\n", harness.name);
            failed = true;
        }
    }
    return failed ? 1 : 0;
}
