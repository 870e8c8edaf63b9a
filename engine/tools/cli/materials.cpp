#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "engine/cloud/material_library.h"
#include "engine/core/quantity.h"
#include "engine/tools/cli/commands.h"

namespace palp {
namespace {

nlohmann::ordered_json materialJson(const KnownMaterial& material)
{
    using Json = nlohmann::ordered_json;
    return {{"name", material.name},
            {"modulus", material.modulus > 0 ? Json(material.modulus) : Json()},
            {"modulus_sd", material.modulus > 0 ? Json(material.modulusError) : Json()},
            {"poisson", material.poissonRatio > -1 ? Json(material.poissonRatio) : Json()},
            {"stiffening", material.stiffening},
            {"relaxation", relaxationText(material.relaxation)},
            {"source", material.source},
            {"licence", material.licence}};
}

void printMaterials()
{
    std::printf("%-27s %-20s %-12s %s\n", "material", "modulus", "stiffening", "relaxation");
    std::string_view source;
    for (const KnownMaterial& material : knownMaterials()) {
        if (material.source != source) {
            source = material.source;
            std::printf("  %s (%s)\n", std::string(source).c_str(), std::string(material.licence).c_str());
        }
        const std::string modulus = material.modulus > 0 ? formatQuantity(material.modulus, "Pa") + " sd " +
                                                               formatQuantity(material.modulusError, "Pa")
                                                         : "the object's own";
        char              stiffening[24];
        std::snprintf(stiffening, sizeof stiffening, "%.4g 1/m", material.stiffening);
        std::printf("%-27s %-20s %-12s %s\n", std::string(material.name).c_str(), modulus.c_str(), stiffening,
                    relaxationText(material.relaxation).c_str());
    }
}

} // namespace

void addMaterialsCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("materials", "lists materials that were measured, for the key material");
    const auto json    = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "machine-readable, SI units");
    command->footer("Examples:\n"
                    "  palpate touch sample:sheet --material ecoflex-0030 --thickness 8mm\n"
                    "A material sets stiffness, poisson, stiffening and relaxation as far as they are known; keys "
                    "beside it win over it.");
    command->callback([json] {
        if (!*json) return printMaterials();
        nlohmann::ordered_json all = nlohmann::ordered_json::array();
        for (const KnownMaterial& material : knownMaterials()) all.push_back(materialJson(material));
        std::cout << jsonText(all);
    });
}

} // namespace palp
