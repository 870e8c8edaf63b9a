#include "engine/pipeline/presets.h"

#include "engine/core/quantity.h"

namespace palp {

PatchSettings withPreset(PatchSettings settings, Preset preset)
{
    const bool paper       = preset == Preset::paper;
    settings.map           = paper ? Map::gallPeters : Map::lambertAzimuthal;
    settings.resampling    = paper ? Resampling::nearest : Resampling::logMean;
    settings.neighbourhood = paper ? Neighbourhood::ball : Neighbourhood::surface;
    settings.forceLaw      = paper ? ForceLaw::paper : ForceLaw::series;
    settings.edges         = {};
    if (paper) settings.foundation = 0;
    if (paper) settings.theory = Theory::plate;
    if (paper) settings.large = Large::off;
    return settings;
}

std::vector<std::string> differencesFromPaper(const PatchSettings& settings)
{
    std::vector<std::string> lines;
    if (settings.map != Map::gallPeters)
        lines.push_back(std::string("map ") + name(settings.map) +
                        ", the paper's is gall-peters: it stretches by sqrt 2 at the contact");
    if (settings.neighbourhood != Neighbourhood::ball)
        lines.push_back(std::string("neighbourhood ") + name(settings.neighbourhood) +
                        ", the paper's is a ball: the other side of a thin body takes part in it");
    if (settings.resampling != Resampling::nearest)
        lines.push_back(std::string("rigidity by ") + name(settings.resampling) +
                        ", the paper's by nearest: it jitters while the grid slides");
    if (settings.theory != Theory::plate)
        lines.push_back(std::string("theory ") + name(settings.theory) +
                        ", the paper's is a plate: what is curved is as soft as what is flat");
    if (settings.large == Large::on)
        lines.push_back("large deflections, the paper has none: a dent of any depth is as stiff as a shallow one");
    if (settings.outside == Outside::body)
        lines.push_back("a window that is cut from a coarse shell of the whole object, the paper's has clamped edges");
    else if (settings.edges != PlateEdges{})
        lines.push_back("edges other than clamped, the paper's are clamped");
    if (settings.foundation != 0)
        lines.push_back("elastic foundation of " + formatQuantity(settings.foundation, "Pa/m") +
                        ", the paper has none: its patch window is felt");
    if (settings.forceLaw != ForceLaw::paper)
        lines.push_back(std::string("force law ") + name(settings.forceLaw) +
                        ", the paper's is E A/h: the plate is not felt");
    return lines;
}

} // namespace palp
