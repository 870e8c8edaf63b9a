#include <iostream>
#include <memory>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/study_report.h"
#include "engine/tools/cli/study_run.h"

// palpate study: blinded trials in a balanced order, answers from the keyboard, a table, and an analysis of tables.

namespace palp {
namespace {

struct StudyOptions {
    StudyRun                 run;
    std::string              out, plot;
    std::vector<std::string> analyse;
    bool                     order = false;
};

void study_(const StudyOptions& o, bool handGiven)
{
    demandSvg("--plot", o.plot);
    if (!o.analyse.empty()) return analyseStudies(o.analyse, o.plot, o.run.json);
    if (o.run.plan.empty()) throw Error("PLAN: expected the file of a study's plan, found none; see samples/studies");
    if (o.run.participant.empty())
        throw Error("--participant: expected a name that ends in a number, such as P01, found none");
    if (!o.run.session.hand.seconds.empty())
        throw Error("--seconds: the plan says how long a touch lasts; change its \"seconds\"");
    const study::StudyPlan plan = study::readPlan(o.run.plan);
    if (o.order) return printOrder(plan, o.run.participant, o.run.json);
    if (o.out.empty()) throw Error("--out: expected a folder for the study, found none");
    demandFolder("--out", o.out);
    StudyRun run             = o.run;
    run.out                  = o.out;
    run.session.hand.seconds = std::to_string(plan.seconds);
    if (!handGiven) run.session.hand.hand = plan.hand;
    demandGood(run.session);
    demandGood(run.session.hand);
    const StudyProgress went = runStudy(run, plan);
    if (run.json)
        std::cout << jsonText(nlohmann::json{{"participant", run.participant},
                                             {"trials", went.trials},
                                             {"done", went.done},
                                             {"paused", went.paused},
                                             {"unfelt", went.unfelt},
                                             {"warnings", went.warnings},
                                             {"table", went.table.string()}});
    else
        std::cout << went.done << " of " << counted(went.trials, "trial") << " in " << went.table.string() << "\n";
}

} // namespace

void addStudyCommand(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("study", "runs blinded trials with participants and analyses their answers");
    const auto o      = std::make_shared<StudyOptions>();
    command->add_option("PLAN", o->run.plan, "file of the study's plan; see samples/studies");
    command->add_option("--participant", o->run.participant, "a name that ends in a number from 1 on, such as P01");
    command->add_option("--out", o->out, "folder of the study, which holds one for each participant");
    command->add_flag("--order", o->order, "prints the participant's whole order, unblinded, and runs nothing");
    command->add_option("--analyse,--analyze", o->analyse,
                        "folders of studies or participants: prints means, shares and intervals of the answers");
    command->add_option("--plot", o->plot, "with --analyse: file for a picture of the shares (.svg)");
    command->add_flag("--json", o->run.json, "machine-readable, SI units; texts for participants go to standard error");
    auto* const hand = (addSessionOptions(*command, o->run.session), command->get_option("--hand"));
    command->footer("A participant sees \"Trial 3 of 20\" and the question. q pauses; the same command resumes. The "
                    "answers are in\nOUT/PARTICIPANT/trials.csv, one row per trial, written to disk before the next "
                    "trial begins.\n"
                    "Examples:\n"
                    "  palpate study samples/studies/paper.json --participant P01 --order\n"
                    "  palpate study samples/studies/paper.json --participant P01 --out study --hand falcon\n"
                    "  palpate study samples/studies/wart_2afc.json --participant P01 --out warts\n"
                    "  palpate study --analyse study --plot shares.svg");
    command->callback([command, hand, o] {
        o->run.session.command = commandOf(*command);
        allowOnlyWith(*command, "--analyse", {"--plot", "--json"});
        allowOnlyWith(*command, "--order", {"PLAN", "--participant", "--json"});
        demandOwner(*command, "--analyse", {"--plot"});
        study_(*o, hand->count() > 0);
    });
}

} // namespace palp
