// palp_soak: sessions in virtual time, one after the other, over all scenes and hands, with faults at random instants.
// A batch is one scene with some sessions; it depends on the seed and its number only, so that a run can go on after
// any batch, and a finding is repeated by that batch alone.
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "engine/session/deformation.h"
#include "engine/session/shipped_scenes.h"
#include "tests/soak/episode.h"
#include "tests/soak/soak_hand.h"

namespace palp::soak {
namespace {

constexpr const char* kUsage =
    R"(usage: palp_soak [--seed N] [--seconds T | --batch N] [--sessions N] [--part K/N] [--state FILE] [--scenes FOLDER]

  --seed N        of everything that is random (1)
  --seconds T     stop after the batch in which this time is over (5)
  --batch N       run this batch only
  --sessions N    in a batch (40)
  --part K/N      every N-th batch, from the K-th on, counted from 0 (0/1)
  --state FILE    go on after the batches that it names, and note there each one that found nothing; a finding ends the run
  --scenes FOLDER (the shipped ones)
)";

struct Options {
    std::uint64_t         seed = 1, first = 0, step = 1;
    double                seconds  = 5;
    std::int64_t          batch    = -1;
    int                   sessions = 40;
    std::string           state;
    std::filesystem::path scenes;
};

struct Totals {
    std::uint64_t batches = 0, sessions = 0, ticks = 0, pressing = 0, judged = 0, troubles = 0, solved = 0;

    void add(const Totals& other)
    {
        batches += other.batches;
        sessions += other.sessions;
        ticks += other.ticks;
        pressing += other.pressing;
        judged += other.judged;
        troubles += other.troubles;
        solved += other.solved;
    }
};

std::ostream& operator<<(std::ostream& out, const Totals& t)
{
    return out << t.batches << " batches, " << t.sessions << " sessions, " << t.ticks << " ticks (" << t.pressing
               << " with a force, " << t.judged << " without contact at the surface), " << t.troubles << " troubles, "
               << t.solved << " plates solved";
}

Options parsed(int count, char** words)
{
    Options                            options;
    std::map<std::string, std::string> given;
    for (int n = 1; n < count; n += 2) {
        if (n + 1 == count || std::string(words[n]).rfind("--", 0) != 0)
            throw Error(std::string("unknown word ") + words[n] + "; see --help");
        given[words[n]] = words[n + 1];
    }
    for (const auto& [flag, text] : given) {
        if (flag == "--seed")
            options.seed = std::stoull(text);
        else if (flag == "--seconds")
            options.seconds = std::stod(text);
        else if (flag == "--batch")
            options.batch = std::stoll(text);
        else if (flag == "--sessions")
            options.sessions = std::stoi(text);
        else if (flag == "--state")
            options.state = text;
        else if (flag == "--scenes")
            options.scenes = text;
        else if (flag == "--part") {
            options.first = std::stoull(text);
            options.step  = std::stoull(text.substr(1 + text.find('/')));
        } else
            throw Error("unknown option " + flag + "; see --help");
    }
    if (options.scenes.empty()) options.scenes = shippedScenesFolder();
    return options;
}

/// Ticks with a force of each hand.
using Pressed = std::map<std::string, std::uint64_t>;

/// Says how long each hand pressed.
/// \return false if one of them never did although there were sessions enough: nobody attacks with it any more
bool eachHandPressed(Pressed& pressed, std::uint64_t sessions)
{
    constexpr std::uint64_t kEnough = 500; // a hand has one session of ten
    bool                    each    = true;
    std::cout << "ticks with a force by the hand:";
    for (const char* const hand : kHands) {
        std::cout << ' ' << hand << ' ' << pressed[hand];
        each = each && pressed[hand] > 0;
    }
    std::cout << std::endl;
    if (!each && sessions >= kEnough) std::cout << "a hand never pressed: see openHand()" << std::endl;
    return each || sessions < kEnough;
}

/// Says what never happened although there were scenes and sessions enough.
/// \return false if there is such a thing: less is tested than this program is for
bool allHappened(const Totals& all)
{
    // More than half of the sessions have troubles, each with a contact solves a plate, and most scenes have a surface
    // that is plain enough to be judged.
    constexpr std::uint64_t kScenes = 3, kSessions = 40;
    bool                    each = true;
    if (all.batches < kScenes || all.sessions < kSessions) return each;
    for (const auto& [count, what] :
         {std::pair{all.judged, "no hand without contact was at a surface"}, std::pair{all.troubles, "nothing failed"},
          std::pair{all.solved, "no plate was solved"}}) {
        each = each && count > 0;
        if (count == 0) std::cout << what << ": too little was tested" << std::endl;
    }
    return each;
}

/// Runs a batch.
/// \return true if nothing was wrong
bool runBatch(const Options& options, const std::vector<ShippedScene>& scenes, std::uint64_t number, Totals& totals,
              Pressed& pressed)
{
    Chance              chance(options.seed * 0x9e3779b97f4a7c15U + number);
    const ShippedScene& shipped = scenes[number % scenes.size()];
    Scene               scene   = readScene(shipped.file);
    scene.solver                = "host";
    const SoftObject object     = loadObject(scene).object;
    Deformation      deformation(object, scene);
    FaultySolver     solver(deformation, chance.bits());
    for (int n = 0; n < options.sessions; ++n) {
        const EpisodeReport report = runEpisode(scene, object, deformation, solver, chance.bits());
        totals.add({0, 1, report.ticks, report.pressing, report.judged, report.troubles, 0});
        pressed[report.hand] += report.pressing;
        if (!report.wrong) continue;
        std::cout << "FOUND in scene " << shipped.name << ", session " << n << " (" << report.what
                  << "): " << *report.wrong << "\n  again: palp_soak --seed " << options.seed << " --sessions "
                  << options.sessions << " --batch " << number << std::endl;
        return false;
    }
    totals.add({1, 0, 0, 0, 0, solver.troubles(), solver.solved()});
    return true;
}

/// Reads the totals of the batches that were run, and the number of the next.
std::uint64_t resumed(const Options& options, Totals& totals)
{
    std::uint64_t next    = options.first;
    int           ignored = 0;
    std::ifstream in(options.state);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::uint64_t      seed = 0, number = 0;
        Totals             one;
        char               end = 0;
        words >> seed >> number >> one.batches >> one.sessions >> one.ticks >> one.pressing >> one.judged >>
            one.troubles >> one.solved;
        if (!(words >> end) || end != '.') { // cut short by a kill
            ignored += !line.empty();
            continue;
        }
        if (seed != options.seed || number % options.step != options.first) continue;
        totals.add(one);
        next = std::max(next, number + options.step);
    }
    if (ignored > 0) std::cout << options.state << ": " << ignored << " lines are not whole, and ignored" << std::endl;
    return next;
}

int run(const Options& options)
{
    using Clock          = std::chrono::steady_clock;
    const auto    scenes = scenesIn(options.scenes);
    const auto    began  = Clock::now();
    Totals        all;
    Pressed       pressed;
    bool          good = false;
    std::uint64_t here = 0; // sessions of this run
    auto          next = options.batch >= 0 ? std::uint64_t(options.batch) : resumed(options, all);
    std::cout << "seed " << options.seed << ", from batch " << next << " on" << std::endl;
    do {
        Totals one;
        good = runBatch(options, scenes, next, one, pressed);
        all.add(one);
        here += one.sessions;
        if (!good) break; // it is not noted, so that the next run begins with it
        if (!options.state.empty() && options.batch < 0)
            std::ofstream(options.state, std::ios::app)
                << '\n'
                << options.seed << ' ' << next << ' ' << one.batches << ' ' << one.sessions << ' ' << one.ticks << ' '
                << one.pressing << ' ' << one.judged << ' ' << one.troubles << ' ' << one.solved << " ." << std::endl;
        next += options.step;
    } while (options.batch < 0 && std::chrono::duration<double>(Clock::now() - began).count() < options.seconds);
    std::cout << all << std::endl;
    if (all.pressing == 0) std::cout << "no session had a force: nothing was tested" << std::endl;
    const bool each     = eachHandPressed(pressed, here);
    const bool happened = options.batch >= 0 || allHappened(all); // a batch that is repeated is one scene
    return good && each && happened && all.pressing > 0 ? 0 : 1;
}

} // namespace
} // namespace palp::soak

int main(int count, char** words)
{
    try {
        if (count == 2 && std::string(words[1]) == "--help") {
            std::cout << palp::soak::kUsage;
            return 0;
        }
        return palp::soak::run(palp::soak::parsed(count, words));
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
