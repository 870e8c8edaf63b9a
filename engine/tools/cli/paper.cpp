#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>
#include <sys/utsname.h>

#include "engine/compute/processor_list.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/processor.h"
#include "engine/core/progress.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/commit.h"
#include "engine/tools/cli/solver_choice.h"
#include "engine/tools/paper/page.h"
#include "engine/tools/paper/parts.h"

// palpate paper: computes the paper's experiments again and writes one page with every number beside it.

namespace palp {
namespace {

using namespace report;

struct PaperOptions {
    std::string out, only, bunny, solver = "auto", command;
    bool        quick = false, json = false;
};

struct Part {
    char                                     letter;
    const char*                              what; ///< for progress
    std::function<Section(const ReportRun&)> make;
};

const std::vector<Part>& parts()
{
    static const std::vector<Part> kParts = {{'a', "pressing the ellipsoid", placesPart},
                                             {'b', "bending the lobe", lobePart},
                                             {'c', "measuring times", timePart},
                                             {'d', "solving random maps", stabilityPart},
                                             {'e', "iterating as Jacobi", jacobiPart},
                                             {'f', "comparing maps", mapsPart},
                                             {'g', "feeling a wart", wartPart},
                                             {'h', "predicting what people notice", perceptionPart},
                                             {'i', "bending what is curved", flatnessPart}};
    return kParts;
}

/// Returns the letters of the wanted parts, in their order.
/// \throws Error naming the known ones
std::string wantedParts(const std::string& only)
{
    std::string known, wanted;
    for (const Part& part : parts()) known += part.letter;
    if (only.empty()) return known;
    std::istringstream words(only);
    for (std::string word; std::getline(words, word, ',');) {
        if (word.size() != 1 || known.find(word[0]) == std::string::npos)
            throw Error("--only: expected parts from a to i with commas between, such as a,c,h, found \"" + only +
                        "\"");
        wanted += word;
    }
    std::erase_if(known, [&](char letter) { return wanted.find(letter) == std::string::npos; });
    return known;
}

/// Returns the processors to time: with auto the host and every usable GPU, else the one that is named.
std::vector<std::string> timedSolvers(const PaperOptions& o, const PlateSolver& solver)
{
    if (!compute::isProcessorWord(o.solver, compute::kAutoProcessor)) return {o.solver};
    std::vector<std::string> solvers;
    if (!compute::isProcessorWord(solver.name(), compute::kHostProcessor)) try {
            for (const compute::Processor& d : compute::listProcessors())
                if (d.refusals.empty() && d.kind != compute::ProcessorKind::software)
                    solvers.push_back(std::to_string(d.index));
        } catch (const compute::ProcessorError&) { // a Vulkan that does not start leaves the host
        }
    solvers.emplace_back(compute::kHostProcessor);
    return solvers;
}

std::string machine()
{
    utsname name{};
    uname(&name);
    return processorName() + ", " + name.sysname + " " + name.release + " " + name.machine;
}

void write(const std::filesystem::path& path, const std::string& text)
{
    writeFileWhole(path, [&](std::ostream& file) { file << text; });
}

void print(const std::vector<Section>& sections, const std::filesystem::path& page)
{
    for (const Section& section : sections)
        for (const Claim& claim : section.claims)
            std::printf("%c  %s\n   ours: %s\n   %s: %s\n\n", section.letter, claim.paper.c_str(), claim.ours.c_str(),
                        name(claim.verdict), claim.words.c_str());
    std::printf("page: %s\n", page.c_str());
}

void paper(const PaperOptions& o)
{
    const std::string wanted = wantedParts(o.only);
    if (!o.bunny.empty() && wanted.find_first_of("bi") == std::string::npos)
        throw Error("--bunny: is used by parts b and i, which --only omits; add b or i to --only");
    SolverChoice choice;
    choice.solver      = o.solver;
    PlateSolver solver = choice.open();
    const int   told   = solver.counts().takeovers;
    if (!o.bunny.empty()) {
        static_cast<void>(openForReading(o.bunny)); // before minutes of work
        std::cerr << bunnyTerms() << "\n";
    }
    demandFolder("--out", o.out);
    makeFolder(o.out);
    std::vector<Section> sections;
    FigureRenderer       renderer;
    for (const Part& part : parts()) {
        if (wanted.find(part.letter) == std::string::npos) continue;
        Progress  progress(std::string(1, part.letter) + " of " + wanted + ": " + part.what);
        ReportRun run{solver, renderer, o.quick, timedSolvers(o, solver),
                      [&](std::size_t done, std::size_t total) { progress.at(done, total); }};
        sections.push_back(part.make(run));
        if (part.letter == 'b' && !o.bunny.empty()) addBunny(sections.back(), o.bunny, run);
        if (part.letter == 'i' && !o.bunny.empty()) addCurvedBunny(sections.back(), o.bunny, run);
    }
    const std::string takeover = sayTakeovers(solver, told);
    warn(renderer.warnings());
    const Origins               origins{PALPATE_VERSION, PALPATE_COMMIT, PALPATE_LIBRARIES, machine(), solver.name(),
                          o.command,       o.quick};
    const std::filesystem::path folder  = o.out;
    const std::string           numbers = numbersJson(sections, origins), timings = timingsJson(sections, origins);
    write(folder / "numbers.json", numbers);
    write(folder / "timings.json", timings);
    write(folder / "index.html", reportPage(sections, origins));
    if (o.json)
        std::cout << jsonText(nlohmann::ordered_json{{"page", (folder / "index.html").string()},
                                                     {"takeover", orNull(takeover)},
                                                     {"numbers", nlohmann::ordered_json::parse(numbers)},
                                                     {"timings", nlohmann::ordered_json::parse(timings)}});
    else
        print(sections, folder / "index.html");
}

/// Returns the command line, quoted for a shell.
std::string commandOf(const PaperOptions& o)
{
    std::string command = "palpate paper --out '" + o.out + "'";
    if (!o.only.empty()) command += " --only " + o.only;
    if (o.quick) command += " --quick";
    if (!o.bunny.empty()) command += " --bunny '" + o.bunny + "'";
    return command + " --solver '" + o.solver + "'";
}

} // namespace

void addPaperCommand(CLI::App& app)
{
    CLI::App* command =
        app.add_subcommand("paper", "computes the paper's experiments again and compares its claims, on one page");
    const auto o = std::make_shared<PaperOptions>();
    command->add_option("--out", o->out, "folder for index.html, numbers.json and timings.json")->required();
    command->add_option("--only", o->only, "parts, such as a,c,h [all]");
    command->add_flag("--quick", o->quick,
                      "fewer points and coarser grids, to check that all parts run; not for its numbers");
    command->add_option("--bunny", o->bunny,
                        "file with your copy of the Stanford bunny, whose ear part b bends too, and all of it part i "
                        "(prints its terms)");
    command
        ->add_option("--solver", o->solver,
                     "where plates are solved, as in palpate solve; auto also times every GPU that works")
        ->capture_default_str();
    command->add_flag("--json", o->json, "prints every number too, SI units");
    command->footer(
        "Parts:\n"
        "  a  the same force at several places of the ellipsoid   e  what Jacobi's iteration does\n"
        "  b  the dip in a thin lobe, clamped and free            f  three equal-area maps on one cap\n"
        "  c  time of a deformation, with its errors              g  felt stiffness over a wart\n"
        "  d  1000 random maps; sides clamped, supported or free  h  what a person would notice, predicted\n"
        "                                                         i  what it costs to bend what is curved as a plate\n"
        "Examples:\n"
        "  palpate paper --out report\n"
        "  palpate paper --out report --only a,f,g --solver host\n"
        "  palpate paper --out report --only b --bunny bun_zipper.ply");
    command->callback([o] {
        o->command = commandOf(*o);
        paper(*o);
    });
}

} // namespace palp
