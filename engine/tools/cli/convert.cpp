#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "engine/cloud/cloud_format.h"
#include "engine/core/contract.h"
#include "engine/session/scene_mesh.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/named_option.h"
#include "engine/tools/cli/scene_source.h"

namespace palp {
namespace {

struct ConvertOptions {
    SceneSource source;
    std::string target, encoding = name(CloudEncoding::binaryLittleEndian);
    bool        json = false, encodingGiven = false;
};

void convert(const ConvertOptions& options)
{
    const CloudEncoding encoding = optionNamed<CloudEncoding>("--encoding", options.encoding);
    const auto&         target   = formatToWrite(options.target);
    if (options.encodingGiven && target.format != CloudFormat::ply && target.format != CloudFormat::pcd)
        throw Error("--encoding has no effect on " + std::string(target.name) + " files, found " +
                    shownPath(options.target) + "; omit it, or name a .ply or .pcd file");
    const Scene scene = withPointsOfFile(options.source.load());
    refuseSourceAsTarget("TARGET", scene.cloud, options.target);
    const LoadedCloud loaded = options.source.loadCloud(scene);
    const bool        faces  = target.holdsFaces;
    writeCloud(options.target, loaded.cloud, FieldsBeside(loaded).all(), {encoding, loaded.faces});
    std::vector<std::string> warnings = cloudWarnings(scene, loaded.cloud, loaded.report);
    for (std::string& line : leftUnwritten(loaded, target)) warnings.push_back(std::move(line));
    if (options.json) {
        nlohmann::json report = cloudJson(options.source.name, loaded.cloud, loaded.faces, loaded.report);
        report["written"]     = options.target;
        report["faces"]       = faces ? loaded.faces.size() : 0;
        report["warnings"]    = warnings;
        std::cout << jsonText(report);
    } else {
        std::cout << options.target << ": " << loaded.cloud.size() << " points, "
                  << (faces && !loaded.faces.empty() ? std::to_string(loaded.faces.size()) + " triangles, " : "")
                  << "metres, stiffness in " << unitOf(loaded.cloud.kind()) << "\n  read as     "
                  << loaded.report.lengthUnitSource << "\n  stiffness   " << loaded.report.stiffnessSource << "\n";
        for (const std::string& line : warnings) std::cout << "  warning     " << line << "\n";
    }
}

} // namespace

void addConvertCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("convert", "reads a cloud and writes it in metres, with its stiffness");
    const auto options = std::make_shared<ConvertOptions>();
    options->source.addTo(*command, SceneKey::Group::object);
    command->add_option("TARGET", options->target, "a " + extensionsFor(CloudUse::writing) + " file")->required();
    command->add_option("--encoding", options->encoding, "encoding of PLY and PCD: " + wordsOf<CloudEncoding>())
        ->capture_default_str();
    command->add_flag("--json", options->json, "machine-readable report");
    command->footer("Examples:\n"
                    "  palpate convert sample:ear-lobe lobe.ply\n"
                    "  palpate convert scan.pcd scan.ply --length-unit mm --stiffness-property intensity \\\n"
                    "    --stiffness-range 20kPa,2MPa\n"
                    "  palpate convert scan.ply ramp.csv --stiffness linear:from=2e4,to=2e6,axis=z");
    command->callback([command, options] {
        options->encodingGiven = command->get_option("--encoding")->count() > 0;
        convert(*options);
    });
}

} // namespace palp
