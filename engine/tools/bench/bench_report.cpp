#include "engine/tools/bench/bench_report.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <ostream>

#include <nlohmann/json.hpp>

#include "engine/tools/plot/line_plot.h"

namespace palp::bench {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json orNull(const std::optional<T>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

Json textOrNull(const std::string& text)
{
    return text.empty() ? Json(nullptr) : Json(text);
}

Json jsonOf(const std::optional<MultigridPlateSolver::CommandCounts>& c)
{
    if (!c) return nullptr;
    return {{"prepare", c->prepare},
            {"prepare_copies", c->prepareCopies},
            {"nested_iteration", c->nested},
            {"step", c->step},
            {"cycle", c->cycle},
            {"after_steps", c->last}};
}

Json jsonOf(const BenchRow& r)
{
    const auto time = [](const std::optional<Quartiles>& q, double Quartiles::*which) {
        return q ? Json(*q.*which) : Json(nullptr);
    };
    const auto named = [](const std::vector<std::string>& names, const std::vector<double>& values) {
        if (values.empty()) return Json(nullptr);
        Json parts = Json::object();
        for (std::size_t n = 0; n < values.size() && n < names.size(); ++n) parts[names[n]] = values[n];
        return parts;
    };
    const std::vector<std::string> peerParts = r.peerPartsMs.size() == 3
                                                   ? std::vector<std::string>{"values", "factor", "solve"}
                                                   : std::vector<std::string>{"solve"};
    return {{"case", r.kind},
            {"map", textOrNull(r.map)},
            {"nodes", orNull(r.nodes)},
            {"accuracy", textOrNull(r.accuracy)},
            {"target", orNull(r.target)},
            {"peer", textOrNull(r.peer)},
            {"peer_ms", time(r.peerMs, &Quartiles::median)},
            {"palpate_ms", time(r.palpateMs, &Quartiles::median)},
            {"ratio", orNull(r.ratio())},
            {"error", orNull(r.error)},
            {"peer_error", orNull(r.peerError)},
            {"work_units", orNull(r.workUnits)},
            {"iterations", orNull(r.iterations)},
            {"tolerance", orNull(r.tolerance)},
            {"peer_lower_ms", time(r.peerMs, &Quartiles::lower)},
            {"peer_upper_ms", time(r.peerMs, &Quartiles::upper)},
            {"palpate_lower_ms", time(r.palpateMs, &Quartiles::lower)},
            {"palpate_upper_ms", time(r.palpateMs, &Quartiles::upper)},
            {"peer_parts_ms", named(peerParts, r.peerPartsMs)},
            {"palpate_parts_ms", named(r.partNames, r.palpatePartsMs)},
            {"other_threads_share", orNull(r.hidden)},
            {"peer_bytes", orNull(r.peerBytes)},
            {"palpate_bytes", orNull(r.palpateBytes)},
            {"residual", orNull(r.residual)},
            {"peer_residual", orNull(r.peerResidual)},
            {"peer_sweeps", orNull(r.peerSweeps)},
            {"extrapolated", orNull(r.extrapolated)},
            {"points", orNull(r.points)},
            {"neighbours", orNull(r.neighbours)},
            {"loads", orNull(r.loads)},
            {"dispatches_per_cycle", orNull(r.dispatchesPerCycle)},
            {"schedule", textOrNull(r.schedule)},
            {"dispatches", jsonOf(r.commands)},
            {"moved_gb_per_s", orNull(r.movedGigabytes)},
            {"copy_gb_per_s", orNull(r.copyGigabytes)},
            {"note", textOrNull(r.note)}};
}

/// Formats a number; "-" where there is none.
std::string cell(const std::optional<double>& value, const char* format)
{
    if (!value) return "-";
    char text[32];
    std::snprintf(text, sizeof text, format, *value);
    return text;
}

std::string cell(const std::optional<Quartiles>& q)
{
    if (!q) return "-";
    char text[64];
    std::snprintf(text, sizeof text, "%.3g (%.3g..%.3g)", q->median, q->lower, q->upper);
    return text;
}

constexpr const char* kColumns = "%-8s %-10s %5s %-14s %-26s %25s %25s %8s %8s %8s %5s %5s";

std::string lineOf(const BenchRow& r)
{
    const bool  bytes  = r.peerBytes || r.palpateBytes;
    const auto  mega   = [](const std::optional<double>& b) { return b ? cell(*b / 1e6, "%.1f MB") : "-"; };
    std::string theirs = bytes ? mega(r.peerBytes) : cell(r.peerMs);
    if (r.extrapolated.value_or(false)) theirs = "extrapolated " + cell(r.peerMs->median, "%.3g");
    char text[400];
    std::snprintf(text, sizeof text, kColumns, r.kind.c_str(), r.map.empty() ? "-" : r.map.c_str(),
                  r.nodes ? std::to_string(*r.nodes).c_str() : cell(r.neighbours, "%.0f").c_str(), r.accuracy.c_str(),
                  r.peer.c_str(), theirs.c_str(), bytes ? mega(r.palpateBytes).c_str() : cell(r.palpateMs).c_str(),
                  cell(r.ratio(), "%.3g").c_str(), cell(r.error, "%.1e").c_str(), cell(r.peerError, "%.1e").c_str(),
                  r.iterations ? std::to_string(*r.iterations).c_str() : "-", cell(r.workUnits, "%.0f").c_str());
    return text;
}

} // namespace

void printText(std::ostream& out, const BenchReport& report)
{
    out << "Palpate on " << report.solver << "; " << report.processor << "\n"
        << "CHOLMOD: " << report.cholmod << "\nEigen: " << report.eigen << "; nanoflann: " << report.nanoflann << "\n"
        << "medians (quartiles) in ms of "
        << (report.clock == Clock::processor
                ? "processor time, one thread each"
                : "time on the wall for Palpate and of processor time for peers, one thread")
        << ", " << report.runs << " runs in turns; ratio = peer / Palpate\n\n";
    char head[400];
    std::snprintf(head, sizeof head, kColumns, "case", "map", "nodes", "accuracy", "peer", "peer [ms]", "Palpate [ms]",
                  "ratio", "error", "peer's", "steps", "work");
    out << head << "\n";
    for (const BenchRow& row : report.rows) {
        out << lineOf(row) << "\n";
        if (!row.note.empty()) out << "          " << row.note << "\n";
        if (row.loads && row.dispatchesPerCycle)
            out << "          " << *row.loads << (*row.loads == 1 ? " load, " : " loads, ")
                << cell(row.palpateMs->median / *row.loads, "%.3g") << " ms each; " << *row.dispatchesPerCycle
                << " dispatches per cycle; " << cell(row.movedGigabytes, "%.1f") << " GB/s where a copy has "
                << cell(row.copyGigabytes, "%.1f") << "\n";
    }
    out.flush();
}

std::string jsonOf(const BenchReport& report)
{
    Json rows = Json::array();
    for (const BenchRow& row : report.rows) rows.push_back(jsonOf(row));
    const Json all = {{"solver", report.solver},
                      {"clock", report.clock == Clock::processor ? "processor" : "wall"},
                      {"processor", report.processor},
                      {"cholmod", report.cholmod},
                      {"eigen", report.eigen},
                      {"nanoflann", report.nanoflann},
                      {"runs", report.runs},
                      {"quick", report.quick},
                      {"environment", report.environment},
                      {"rows", rows}};
    return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string plotOf(const BenchReport& report, const std::string& kind, const std::string& map)
{
    std::vector<PlotSeries> series;
    const auto add = [&](const std::string& name, const BenchRow& row, const std::optional<Quartiles>& time) {
        if (!time || !row.nodes) return;
        auto at = std::ranges::find_if(series, [&](const PlotSeries& s) { return s.name == name; });
        if (at == series.end()) at = series.insert(series.end(), PlotSeries{name, {}, {}, SeriesStyle::lineAndMarkers});
        if (!at->x.empty() && at->x.back() == double(*row.nodes)) return; // two accuracies share one peer
        at->x.push_back(*row.nodes);
        at->y.push_back(time->median / 1e3);
    };
    for (const BenchRow& row : report.rows) {
        if (row.kind != kind || row.map != map) continue;
        add(row.peer, row, row.peerMs);
        if (row.error && !(row.target && *row.error > *row.target)) add("Palpate, " + row.accuracy, row, row.palpateMs);
    }
    LinePlotSettings plot;
    plot.title = (kind == "new_load" ? "A new load, rigidity " : "A new map of rigidity and a solve, ") + map;
    plot.x     = {"nodes a side", "", Scale::logarithmic, {}};
    plot.y     = {"processor time", "s", Scale::logarithmic, {}};
    return linePlotSvg(series, plot);
}

} // namespace palp::bench
