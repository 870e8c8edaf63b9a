// palpate: the command line. Exit codes: 0 good, 1 a failed check or an internal fault, 2 bad usage or input, 4 a
// requested GPU cannot be used.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "engine/compute/context.h"
#include "engine/compute/processor_error.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/nearest_name.h"
#include "engine/core/shown_text.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/manual.h"
#include "engine/tools/cli/version.h"

namespace {

constexpr int kBadInput    = 2;
constexpr int kOurFault    = 1;
constexpr int kCheckFailed = 1;
constexpr int kNoGpu       = 4; // 3 is a missing package, see engine/prepare.sh

constexpr const char* kUnprinted = "standard output cannot be written";

/// Flushes both libraries' output and checks that it has been written. Where its reader has gone, as head does, that
/// ends the program without a word, as it ends others; but only here, not in the middle of a session.
bool printed()
{
    std::cout.flush();
    const bool good = std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout);
    pollfd     reader{STDOUT_FILENO, POLLOUT, 0};
    if (!good && ::poll(&reader, 1, 0) == 1 && (reader.revents & POLLERR) != 0) {
        std::signal(SIGPIPE, SIG_DFL);
        std::raise(SIGPIPE);
    }
    return good;
}

int complain(const std::string& sentence, int code)
{
    std::cout.flush();
    std::cerr << "palpate: " << sentence << "\n";
    return code;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& known)
{
    const auto meant = palp::nearestName(word, std::vector<std::string_view>(known.begin(), known.end()));
    return meant ? "; did you mean " + std::string(*meant) + "?" : "";
}

/// Names an unknown command, where the library would only say that some command is required.
void refuseUnknownCommand(const CLI::App& app, const std::string& name)
{
    std::vector<std::string> known;
    std::string              listed;
    for (const CLI::App* command : app.get_subcommands({})) {
        if (name.starts_with('-') || command->get_name() == name) return;
        known.push_back(command->get_name());
        listed += (listed.empty() ? "" : ", ") + command->get_name();
    }
    throw palp::Error("unknown command " + palp::inQuotes(name) + didYouMean(name, known) + "; known: " + listed +
                      "; see --help");
}

/// Returns a sentence about the first option that a command does not know, or else about words that it has no use for.
std::string onUnknownWords(const CLI::App& app)
{
    const auto               commands = app.get_subcommands();
    const CLI::App&          command  = commands.empty() ? app : *commands.front();
    std::vector<std::string> known;
    const std::string        of = commands.empty() ? "palpate" : "palpate " + command.get_name();
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    std::string unused;
    for (const std::string& word : app.remaining(true)) {
        if (word.size() > 1 && word.front() == '-')
            return of + ": unknown option " + palp::shownText(word, palp::kMostOfWord) + didYouMean(word, known) +
                   "; see " + of + " --help";
        unused += (unused.empty() ? "" : " ") + word;
    }
    return of + ": found " + palp::inQuotes(unused) + " where no further word is expected; see " + of + " --help";
}

/// Refuses options that are given an empty value.
void refuseEmptyValues(const CLI::App& command)
{
    for (const CLI::Option* option : command.get_options())
        for (const std::string& value : option->results())
            if (value.empty()) throw palp::Error(option->get_name() + ": expected a value, found \"\"");
}

/// Turns "help solve" into "solve --help".
std::vector<const char*> wordsOf(int argumentCount, char** arguments)
{
    std::vector<const char*> words(arguments, arguments + argumentCount);
    if (words.size() < 2 || std::string(words[1]) != "help") return words;
    words.erase(words.begin() + 1);
    words.push_back("--help");
    return words;
}

/// Returns whether the system gave this as the reason.
bool isFor(std::errc reason, const std::exception& error)
{
    const auto* const system = dynamic_cast<const std::system_error*>(&error);
    return system && system->code() == reason;
}

/// Ends the program without its exit handlers: an allocation that failed inside a driver may have left locks for which
/// the driver's handlers would wait.
[[noreturn]] void leaveWithoutMemory() noexcept
{
    constexpr std::string_view kSentence = "palpate: out of memory; try fewer cells or points\n";
    static_cast<void>(::write(STDERR_FILENO, kSentence.data(), kSentence.size()) == 0); // it takes no memory
    std::_Exit(kBadInput);
}

std::terminate_handler otherEnd = nullptr; ///< the library's: it says what nobody caught

/// Says the same where nobody could catch it: while the program's own constants are made, and in what libraries call
/// noexcept (CLI11 when it looks for an option, nlohmann-json when it takes a document apart). A device's guardian
/// gives zero force.
[[noreturn]] void endWithoutCatch() noexcept
{
    try {
        if (const auto error = std::current_exception()) std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
        leaveWithoutMemory();
    } catch (...) { // a mistake of ours
    }
    otherEnd();
    std::abort();
}

/// Before any other constant of the program is made.
[[gnu::constructor(101)]] void beReadyToEnd() noexcept
{
    otherEnd = std::set_terminate(endWithoutCatch);
}

/// Takes the numbers of standard streams that the caller has closed: the first files that are opened would get them,
/// and sentences would be written into a recording. Using such a stream fails, as if it were closed still.
void keepStandardStreams()
{
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) == -1)
            static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
}

/// Keeps freed memory at hand: every touch needs some megabytes, which the C library would give back and the system
/// would have to clear again, for a fifth of the touch's time.
void keepFreedMemory()
{
#ifdef __GLIBC__
    constexpr int kMegabyte = 1 << 20;         // bytes
    mallopt(M_MMAP_THRESHOLD, 32 * kMegabyte); // the most that it takes
    mallopt(M_TRIM_THRESHOLD, 64 * kMegabyte);
#endif
}

/// Adds a flag that prints a text, and nothing else is done.
void addPrinted(CLI::App& app, const std::string& flag, const std::string& help, std::function<std::string()> text)
{
    app.add_flag_callback(
        flag, [text] { throw CLI::CallForVersion(text(), 0); }, help);
}

/// Adds the options that need no command. Those that come first are read first.
void addOwnOptions(CLI::App& app)
{
    const auto json = std::make_shared<bool>();
    auto*      flag = app.add_flag("--json", *json, "with --version: commit, compiled-in parts and formats, as JSON");
    addPrinted(app, "--version", "prints the version",
               [json] { return *json ? palp::versionJson() : palp::versionLine(); });
    addPrinted(app, "--man", "prints the page of the manual: palpate --man | man -l -",
               [&app] { return palp::manualPage(app); });
    addPrinted(app, "--completion", "prints the completion for bash: eval \"$(palpate --completion)\"",
               [&app] { return palp::bashCompletion(app); });
    flag->needs("--version");
}

const char* const kExamples =
    "Examples:\n"
    "  palpate touch sample:skin --out touch          a poke into a wart, with pictures\n"
    "  palpate info scan.ply --length-unit mm         what a file holds and how it is read\n"
    "  palpate materials                              measured materials, for the key material\n"
    "  palpate fit probes.csv --page probes.html      stiffness, stiffening and relaxation of measured presses\n"
    "  palpate convert sample:palm palm.ply           a procedural object as a file\n"
    "  palpate paint scan.ply --stroke 'at=0,0,30mm radius=5mm value=2MPa' --out wart.ply\n"
    "                                                 a stiff spot on it; the rest of the file is kept\n"
    "  palpate solve plate.json --cells 256 --json    one plate, for scripts\n"
    "  palpate run samples/scenes/palm_wart.json      a hand slides over a wart\n"
    "  palpate export session --csv session.csv       a recorded session as a table\n"
    "  palpate hunt samples/scenes/nodule_hunt.json   a hand's search for hidden nodules, scored\n"
    "  palpate study samples/studies/paper.json --participant P01 --out study   blinded trials, a table of "
    "answers\n"
    "  palpate render sample:palm --out palm.png      a picture of a touch, without a display\n"
    "  palpate perceive sample:skin                   a prediction of what a person would notice\n"
    "  palpate paper --out report                     the paper's experiments, computed again\n"
    "  palpate devices                                processors and haptic devices of this machine\n"
    "  palpate doctor                                 what it lacks for haptics, with remedies\n"
    "  palpate calibrate --mass '200 g'               a Falcon weighs a mass to calibrate its force\n"
    "  palpate bench --quick                          times of its solver and of alternatives\n"
    "Run a command with --help for its options and examples.";

/// Adds the commands in the order in which help shows them.
void addCommands(CLI::App& app)
{
    using namespace palp;
    app.require_subcommand(1);
    addOwnOptions(app);
    app.footer(kExamples);
    for (const auto add : {addTouchCommand, addSolveCommand, addInfoCommand, addMaterialsCommand, addFitCommand,
                           addConvertCommand, addPaintCommand, addDevicesCommand, addDoctorCommand, addRunCommand,
                           addExportCommand, addHuntCommand, addStudyCommand, addRenderCommand, addViewCommand,
                           addPerceiveCommand, addPaperCommand, addCalibrateCommand, addBenchCommand})
        add(app);
    for (CLI::App* command : app.get_subcommands({}))
        command->parse_complete_callback([command] { refuseEmptyValues(*command); });
}

int printHelp(const CLI::App& app, const CLI::ParseError& request)
{
    app.exit(request);
    return printed() ? 0 : complain(kUnprinted, kBadInput);
}

} // namespace

/// Does what the words say.
/// \return the exit code
int runProgram(int argumentCount, char** arguments)
{
    CLI::App app("Palpate: feel a thin, soft object whose stiffness varies from place to place.");
    addCommands(app);
    std::signal(SIGXFSZ, SIG_IGN); // a file beyond the size limit then fails as a write, with a sentence
    std::signal(SIGPIPE, SIG_IGN); // see printed()
    try {
        const std::vector<const char*> words = wordsOf(argumentCount, arguments);
        if (words.size() > 1) refuseUnknownCommand(app, words[1]);
        app.parse(int(words.size()), words.data());
        if (!printed()) return complain(kUnprinted, kBadInput);
    } catch (const CLI::ExtrasError&) {
        return complain(onUnknownWords(app), kBadInput);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return printHelp(app, error); // or --version
        constexpr std::size_t kMost = 400;                            // [bytes] it repeats what was typed
        return complain(palp::shownText(error.what(), kMost) + "; see --help", kBadInput);
    } catch (const palp::CheckFailed&) {
        return printed() ? kCheckFailed : complain(kUnprinted, kBadInput);
    } catch (const palp::compute::ProcessorError& error) {
        return complain(error.what(), kNoGpu);
    } catch (const palp::compute::ProcessorLost& error) {
        return complain(error.what(), kNoGpu);
    } catch (const palp::Error& error) {
        return complain(error.what(), kBadInput);
    } catch (const std::bad_alloc&) {
        leaveWithoutMemory();
    } catch (const std::exception& error) {
        if (isFor(std::errc::not_enough_memory, error)) leaveWithoutMemory();
        if (isFor(std::errc::resource_unavailable_try_again, error))
            return complain(
                "the system starts no more threads for this user; end other programs, or raise the limit (ulimit -u)",
                kBadInput);
        if (const auto* const file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
            return complain(palp::sentenceOf(*file), kBadInput);
        return complain(std::string("internal error, please report it: ") + error.what(), kOurFault);
    }
    return 0;
}

int main(int argumentCount, char** arguments)
try {
    keepStandardStreams();
    keepFreedMemory();
    const int code = runProgram(argumentCount, arguments);
    if (palp::compute::driverLeftAtWork()) std::_Exit(code); // all output has been flushed
    return code;
} catch (const std::bad_alloc&) { // while the command line was made
    leaveWithoutMemory();
}
