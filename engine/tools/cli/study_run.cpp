#include "engine/tools/cli/study_run.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <utility>

#include <glm/geometric.hpp>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/file.h"
#include "engine/core/shown_text.h"
#include "engine/session/hand_path.h"
#include "engine/session/interrupt.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/commit.h"
#include "engine/tools/study/study_file.h"
#include "engine/tools/study/trial_table.h"

namespace palp {
namespace {

using study::Condition;
using study::StudyPlan;
using study::Task;
using study::TaskKind;
using study::Trial;
using study::TrialRow;

constexpr std::size_t kLongestLine = 1000; ///< [bytes] kept of an answer
constexpr const char* kWarnings    = "warnings.txt";
constexpr int         kMostStrange = 20; ///< unknown answers in a row from input that is no terminal

/// A condition, ready to be touched.
struct Felt {
    LoadedObject loaded;

    explicit Felt(const Scene& scene) : loaded(loadObject(scene)) {}

    /// Returns the stiffness at the scene's place, as the device renders it [N/m]; nothing where nothing can be felt.
    [[nodiscard]] std::optional<double> stiffness(const Scene& scene) const
    {
        try {
            const HandPlace place = handPlace(scene, loaded.object);
            PlateSolver     host("host");
            const Patch     patch = deform(loaded.object, {place.point, place.outward}, scene.patch, host);
            return std::min(patch.feltStiffness, scene.stiffnessCap / scene.workspaceScale);
        } catch (const Error&) { // a hand from a file may work elsewhere
            return std::nullopt;
        }
    }
};

using Answers = std::map<std::string, std::string>; ///< from what is typed to what the table holds

/// The participant pauses, to resume later.
struct Paused {};

/// Discards keys that were hit while an object was touched, so that they answer nothing.
void forgetKeys()
{
    if (isatty(STDIN_FILENO) != 0) ::tcflush(STDIN_FILENO, TCIFLUSH);
}

/// Reads a line from the keyboard or from a file in its place.
/// \throws Paused at its end or at Ctrl-C
std::string keyedLine()
{
    constexpr int            kLook = 100; // [ms] period of checks for Ctrl-C, which may come between two waits
    const std::atomic<bool>& stop  = catchInterrupts();
    std::string              text;
    for (char c = 0;;) {
        pollfd    keys{STDIN_FILENO, POLLIN, 0};
        const int ready = ::poll(&keys, 1, kLook);
        if (stop) throw Paused();
        if (ready <= 0) continue;
        const ssize_t got = ::read(STDIN_FILENO, &c, 1);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0 && text.empty()) throw Paused();
        if (got <= 0 || c == '\n') return text;
        if (text.size() < kLongestLine) text += c; // no answer is this long
    }
}

/// Force over the time in contact.
struct ForceTally {
    double        sum = 0, peak = 0; ///< [N]
    std::uint64_t ticks = 0;

    void add(const TickRecord& record)
    {
        if (record.normal == glm::dvec3(0)) return;
        const double force = glm::length(record.force);
        sum += force, ++ticks;
        peak = std::max(peak, force);
    }
    void add(const ForceTally& other)
    {
        sum += other.sum, ticks += other.ticks;
        peak = std::max(peak, other.peak);
    }
    [[nodiscard]] double mean() const { return ticks > 0 ? sum / double(ticks) : 0; }
};

/// One participant's run.
class Sitting {
public:
    Sitting(const StudyRun& run, const StudyPlan& plan)
        : run_(run), plan_(plan), trials_(trialsOf(plan, study::participantNumber(run.participant))),
          folder_(run.out / run.participant)
    {
        for (const Condition& condition : plan.conditions) felt_.emplace_back(condition.scene);
        agree();
        lock_.emplace(folder_, "another process runs this participant's trials; end it first");
        table_.emplace(folder_ / "trials.csv");
        demandOurs();
    }

    StudyProgress go()
    {
        bool paused = false;
        try {
            while (table_->rows().size() < trials_.size()) table_->append(trial(table_->rows().size()));
            say("That was the last trial. Thank you.\n");
        } catch (const Paused&) {
            paused = true;
            say("\nPaused after " + std::to_string(table_->rows().size()) + " of " + counted(trials_.size(), "trial") +
                "; run the same command to resume.\n");
        } catch (...) {
            tellUnfelt();
            tellWarnings();
            throw;
        }
        tellUnfelt();
        tellWarnings();
        StudyProgress went{table_->rows().size(), trials_.size(), paused, folder_ / "trials.csv", warnings_, {}};
        for (const TrialRow& row : table_->rows())
            if (!row.wasFelt()) went.unfelt.push_back(row.trial);
        return went;
    }

private:
    void                      agree();
    void                      demandOurs() const;
    void                      tellUnfelt() const;
    void                      keepWarnings(const std::vector<std::string>& sentences);
    void                      tellWarnings() const;
    TrialRow                  trial(std::size_t number);
    std::string               touch(std::size_t condition, const std::string& name, ForceTally& force);
    [[nodiscard]] std::string ask(const Task& task) const;
    [[nodiscard]] std::string line() const;
    [[nodiscard]] std::string answerAmong(const Answers& known, const std::string& wanted) const;
    void                      begin(const std::string& what) const;
    void say(const std::string& text) const { (run_.json ? std::cerr : std::cout) << text << std::flush; }

    const StudyRun&                  run_;
    const StudyPlan&                 plan_;
    std::vector<Trial>               trials_;
    std::filesystem::path            folder_;
    std::vector<Felt>                felt_;
    std::optional<FolderLock>        lock_;
    std::optional<study::TrialTable> table_;
    bool                             handIsKnown_ = false; ///< what there is to say of it was said
    std::vector<std::string>         warnings_;            ///< of the sessions so far, with their trials
};

/// Returns the hand without the port of its device, which may change from day to day.
std::string withoutPort(const std::string& hand)
{
    return hand.substr(0, hand.find('@'));
}

/// Returns the fingerprint of a hand's file; nothing if the hand is none.
std::optional<std::string> pathOf(const std::string& hand)
{
    if (deviceNamed(hand) || valueNamed<HandMotion>(hand)) return std::nullopt;
    return fingerprint(readHand(hand));
}

/// Returns the folders of a study's participants; none where the study is new.
std::vector<std::filesystem::path> othersIn(const std::filesystem::path& study)
{
    std::vector<std::filesystem::path> found;
    std::error_code                    failure;
    for (std::filesystem::directory_iterator entry(study, failure), end; !failure && entry != end;
         entry.increment(failure))
        if (std::error_code hidden; std::filesystem::exists(entry->path() / study::kStudyFile, hidden))
            found.push_back(entry->path());
        else if (hidden && hidden != std::errc::permission_denied) // as lost+found of a disk, which is nobody's study
            throw Error(entry->path().string() + ": cannot be read: " + hidden.message());
    if (failure && failure != std::errc::no_such_file_or_directory)
        throw Error(study.string() + ": cannot be read: " + failure.message());
    return found;
}

/// Writes the study's file once; later runs must agree with it.
void Sitting::agree()
{
    const std::filesystem::path path = folder_ / study::kStudyFile;
    study::StudyFile            now{.participant = run_.participant,
                                    .title       = plan_.title,
                                    .plan        = plan_.canonical,
                                    .hand        = run_.session.hand.hand,
                                    .path        = pathOf(run_.session.hand.hand),
                                    .clock       = run_.session.clock,
                                    .motion      = motionOf(run_.session.hand) + ", threads " + run_.session.threads,
                                    .version     = PALPATE_VERSION " " PALPATE_COMMIT};
    for (const Felt& felt : felt_) now.clouds.push_back(fingerprint(felt.loaded.object.cloud()));
    if (isThere(path)) {
        const study::StudyFile before = study::readStudyFile(folder_);
        if (before.participant != now.participant || before.plan != now.plan || before.clouds != now.clouds)
            throw Error(path.string() + ": expected the plan that this participant began with, found that " +
                        run_.plan + " or a scene of it has changed since; choose another --out");
        const auto demandSame = [&](const char* option, const std::optional<std::string>& was,
                                    const std::optional<std::string>& is, const auto& wordOf) {
            if (was && wordOf(*was) != wordOf(*is))
                throw Error(path.string() + ": expected the " + option + " that this participant began with, \"" +
                            *was + "\", found \"" + *is + "\"; trials could not be compared; choose another --out");
        };
        if (!before.path && now.path) // of an earlier version; the same file may have another name from another folder
            demandSame("--hand", before.hand, now.hand,
                       [](const std::filesystem::path& hand) { return hand.filename(); });
        else if (!now.path)
            demandSame("--hand", before.hand, now.hand, withoutPort);
        else if (*before.path != *now.path)
            throw Error(path.string() + ": expected the path of a hand that this participant began with, found that " +
                        shownPath(*now.hand) +
                        " has another one, or has changed since; trials could not be compared; choose another --out");
        demandSame("--clock", before.clock, now.clock, std::identity());
        demandSame("motion of the hand", before.motion, now.motion, std::identity());
        return;
    }
    for (const auto& other : othersIn(run_.out))
        if (study::readStudyFile(other).plan != now.plan)
            throw Error((other / study::kStudyFile).string() + ": expected participants of one plan in " +
                        run_.out.string() + ", found that " + run_.plan +
                        " or a scene of it has changed since; choose another --out");
    makeFolder(folder_);
    for (std::size_t k = 0; k < felt_.size(); ++k)
        now.feltStiffness[plan_.conditions[k].name] = felt_[k].stiffness(plan_.conditions[k].scene);
    writeFileWhole(path, [&](std::ostream& file) { file << study::studyJson(now); });
}

/// Checks that every row is the trial that the order has there.
void Sitting::demandOurs() const
{
    const auto& rows = table_->rows();
    bool        ours = rows.size() <= trials_.size();
    for (std::size_t k = 0; ours && k < rows.size(); ++k) {
        const Trial& trial = trials_[k];
        ours               = rows[k].participant == run_.participant && rows[k].trial == k + 1 &&
               rows[k].task == plan_.tasks[trial.task].name && rows[k].first == plan_.conditions[trial.first].name &&
               rows[k].second == (trial.second ? plan_.conditions[*trial.second].name : "");
    }
    if (!ours)
        throw Error((folder_ / "trials.csv").string() +
                    ": expected the trials of this participant in their order, found others; was the table changed?");
}

/// Warns the experimenter of answers that have no touch behind them.
void Sitting::tellUnfelt() const
{
    for (const TrialRow& row : table_->rows())
        if (!row.wasFelt())
            std::cerr << "palpate: trial " << row.trial << ": nothing was felt"
                      << (row.second.empty() ? "" : " in one of its touches")
                      << ": the hand never touched or had no force; its answer is not valid, and --analyse leaves it "
                         "out\n";
}

/// Adds to a file what the participant must not read: it says what is touched. It is on the disk before the question is
/// asked.
void Sitting::keepWarnings(const std::vector<std::string>& sentences)
{
    constexpr std::size_t kMost = std::size_t(16) << 20; // [bytes]
    if (sentences.empty()) return;
    const std::filesystem::path path = folder_ / kWarnings;
    std::string text = isThere(path) ? readWhole(path, kMost, "the warnings of a participant's trials") : "";
    for (const std::string& sentence : sentences) {
        warnings_.push_back("trial " + std::to_string(table_->rows().size() + 1) + ": " + sentence);
        text += warnings_.back() + "\n";
    }
    writeFileWhole(path, [&](std::ostream& file) { file << text; });
}

void Sitting::tellWarnings() const
{
    if (!warnings_.empty())
        warn({"who runs the study should read " + (folder_ / kWarnings).string() +
              ", which the participant should not"});
}

std::string Sitting::line() const
{
    std::string text = keyedLine();
    const auto  good = text.find_first_not_of(" \t\r");
    if (good == std::string::npos) return "";
    text = text.substr(good, text.find_last_not_of(" \t\r") - good + 1);
    std::ranges::transform(text, text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    if (text == "q") throw Paused();
    return text;
}

/// Asks again until the answer is a known one.
/// \throws Error after many unknown answers in a row from input that is no terminal: a file's end may be far
std::string Sitting::answerAmong(const Answers& known, const std::string& wanted) const
{
    for (int strange = 1;; ++strange) {
        const std::string text   = line();
        const auto        answer = known.find(text);
        if (answer != known.end()) return answer->second;
        if (strange >= kMostStrange && isatty(STDIN_FILENO) == 0) {
            say("\n");
            throw Error("standard input: expected a line that would " + wanted + ", found " +
                        std::to_string(kMostStrange) +
                        " other lines in a row; this trial is not recorded; run the same command to repeat it");
        }
        say("  please " + wanted + ", or q: ");
    }
}

void Sitting::begin(const std::string& what) const
{
    forgetKeys();
    say(what + " Enter begins, q pauses: ");
    static_cast<void>(answerAmong({{"", ""}}, "press Enter alone"));
}

std::string Sitting::ask(const Task& task) const
{
    const bool           rating = task.kind == TaskKind::rating, pair = task.kind == TaskKind::twoAlternative;
    static const Answers kRatings{{"1", "1"}, {"2", "2"}, {"3", "3"}, {"4", "4"}, {"5", "5"}};
    static const Answers kYesNo{{"y", "yes"}, {"yes", "yes"}, {"n", "no"}, {"no", "no"}};
    static const Answers kPair{{"1", "first"}, {"first", "first"}, {"2", "second"}, {"second", "second"}};
    const auto&          known  = rating ? kRatings : pair ? kPair : kYesNo;
    const std::string    choice = rating ? "1 to 5" : pair ? "1 or 2" : "y or n";
    const auto           end = [](const std::string& meaning) { return meaning.empty() ? "" : " (" + meaning + ")"; };
    forgetKeys();
    say(task.question + "\n" + (rating ? "  1" + end(task.least) + " to 5" + end(task.most) : "  " + choice) +
        "; q pauses: ");
    return answerAmong(known, "answer " + choice);
}

/// Runs one touch.
/// \return the session's folder, from the study's
std::string Sitting::touch(std::size_t condition, const std::string& name, ForceTally& force)
{
    std::error_code ignored;
    std::string     fresh = name;
    for (int again = 2; std::filesystem::exists(folder_ / fresh, ignored); ++again) // after a trial that did not count
        fresh = name + "_again" + std::to_string(again);
    SessionOptions options   = run_.session;
    options.record           = (folder_ / fresh).string();
    options.blind            = true;
    options.handIsKnown      = std::exchange(handIsKnown_, true);
    const SessionRun session = runSession(plan_.conditions[condition].scene, felt_[condition].loaded, options,
                                          [&](const TickRecord& record) { force.add(record); });
    keepWarnings(session.warnings);
    if (!session.takeover.empty()) keepWarnings({session.takeover});
    if (session.interrupted) throw Paused();
    if (!session.takeover.empty()) std::cerr << "palpate: " << session.takeover << "\n";
    try {
        demandWhole(session);
    } catch (const CheckFailed& failed) {
        std::cerr << "palpate: " << failed.what() << ": this trial does not count; run the same command to repeat it\n";
        throw;
    }
    return run_.participant + "/" + fresh;
}

TrialRow Sitting::trial(std::size_t number)
{
    const Trial&      trial = trials_[number];
    const Task&       task  = plan_.tasks[trial.task];
    const std::string which = "Trial " + std::to_string(number + 1) + " of " + std::to_string(trials_.size());
    char              stem[32];
    std::snprintf(stem, sizeof stem, "trial_%03zu", number + 1);
    TrialRow   row;
    ForceTally force, second;
    begin("\n" + which + (trial.second ? ", the first of two." : "."));
    row.firstSession = touch(trial.first, stem, force);
    if (trial.second) {
        begin(which + ", the second.");
        row.secondSession = touch(*trial.second, std::string(stem) + "_second", second);
        row.second        = plan_.conditions[*trial.second].name;
    }
    const auto asked = std::chrono::steady_clock::now();
    row.answer       = ask(task);
    row.reactionTime = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
    row.participant  = run_.participant;
    row.trial        = number + 1;
    row.block        = trial.block;
    row.task         = task.name;
    row.kind         = name(task.kind);
    row.first        = plan_.conditions[trial.first].name;
    row.question     = task.question;
    if (trial.right) row.correct = row.answer == *trial.right;
    row.seed = plan_.seed;
    row.felt = force.peak > 0 && (!trial.second || second.peak > 0);
    force.add(second);
    row.meanForce = force.mean();
    row.peakForce = force.peak;
    row.version   = PALPATE_VERSION " " PALPATE_COMMIT;
    return row;
}

} // namespace

StudyProgress runStudy(const StudyRun& run, const StudyPlan& plan)
{
    return Sitting(run, plan).go();
}

} // namespace palp
