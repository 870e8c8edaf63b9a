#include "engine/tools/paper/page.h"

#include <sstream>
#include <string_view>

namespace palp::report {
namespace {

constexpr const char* kStyle =
    "body{font:16px/1.5 sans-serif;max-width:76rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a;background:#fff}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.5rem 0 1.5rem}"
    "caption{text-align:left;caption-side:top;color:#444}"
    "td,th{padding:.2rem .8rem .2rem 0;text-align:left;vertical-align:top;border-bottom:1px solid #ddd}"
    ".figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(30rem,1fr));gap:1.5rem}"
    "figure{margin:0}figure>svg{width:100%;height:auto;max-height:34rem}figcaption{color:#444}"
    ".holds{font-weight:bold;color:#005b8f}.inPart{font-weight:bold;color:#7a5200}.fails{font-weight:bold;color:#"
    "a33b00}"
    "p{max-width:50rem}code{background:#f2f2f2;padding:.1rem .3rem}"
    "@media print{figure,tr{break-inside:avoid}}";

std::string escaped(std::string_view text)
{
    std::string result;
    for (const char c : text) switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c;
        }
    return result;
}

const char* classOf(Verdict verdict)
{
    return verdict == Verdict::holds ? "holds" : verdict == Verdict::inPart ? "inPart" : "fails";
}

void addTable(std::ostringstream& html, const Table& table)
{
    html << "<table><caption>" << escaped(table.caption) << "</caption>\n<tr>";
    for (const std::string& heading : table.headings) html << "<th>" << escaped(heading) << "</th>";
    html << "</tr>\n";
    for (const auto& row : table.rows) {
        html << "<tr>";
        for (const std::string& cell : row) html << "<td>" << escaped(cell) << "</td>";
        html << "</tr>\n";
    }
    html << "</table>\n";
}

void addClaims(std::ostringstream& html, std::span<const Section> sections)
{
    html << "<h2>The paper's claims</h2>\n<table><tr><th>part</th><th>the paper</th><th>our figure</th><th>how it is "
            "made</th><th>verdict</th></tr>\n";
    for (const Section& section : sections)
        for (const Claim& claim : section.claims)
            html << "<tr><td><a href=\"#" << section.letter << "\">" << section.letter << "</a></td><td>"
                 << escaped(claim.paper) << "</td><td>" << escaped(claim.ours) << "</td><td>" << escaped(claim.how)
                 << "</td><td><span class=\"" << classOf(claim.verdict) << "\">" << name(claim.verdict) << "</span>. "
                 << escaped(claim.words) << "</td></tr>\n";
    html << "</table>\n";
}

void addSection(std::ostringstream& html, const Section& section)
{
    html << "<h2 id=\"" << section.letter << "\">" << section.letter << ". " << escaped(section.title) << "</h2>\n";
    for (const std::string& paragraph : section.text) html << "<p>" << escaped(paragraph) << "</p>\n";
    for (const Table& table : section.tables) addTable(html, table);
    html << "<div class=\"figures\">\n";
    for (const Figure& figure : section.figures)
        html << "<figure>" << figure.svg.substr(figure.svg.find("<svg")) << "<figcaption>" << escaped(figure.caption)
             << "</figcaption></figure>\n";
    html << "</div>\n";
}

/// Writes all of a page up to its title.
void addHead(std::ostringstream& html, const std::string& name, const std::string& title)
{
    html << "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
            "content=\"width=device-width\"><title>"
         << escaped(name) << "</title>\n<style>" << kStyle << "</style></head><body>\n<h1>" << escaped(title)
         << "</h1>\n";
}

} // namespace

std::string plainPage(const std::string& title, std::span<const std::string> text, std::span<const Section> sections)
{
    std::ostringstream html;
    addHead(html, "Palpate: " + title, title);
    for (const std::string& paragraph : text) html << "<p>" << escaped(paragraph) << "</p>\n";
    for (const Section& section : sections) addSection(html, section);
    html << "</body></html>\n";
    return html.str();
}

std::string reportPage(std::span<const Section> sections, const Origins& origins)
{
    std::ostringstream html;
    addHead(html, "Palpate: the paper, computed again", "The paper, computed again");
    html << "<p>Kumari and Chaudhuri, “Haptic Rendering of Thin, Deformable Objects with Spatially Varying Stiffness” "
            "(arXiv 2005.11799). Its claims are in our words. Every figure and number below was made by one command, "
            "<code>"
         << escaped(origins.command)
         << "</code>. The numbers are in <a href=\"numbers.json\">numbers.json</a>, measured times are in <a "
            "href=\"timings.json\">timings.json</a>.</p>\n";
    if (origins.quick)
        html << "<p><strong>A quick run:</strong> fewer points and coarser grids, to see that all works. Its numbers "
                "are not the report's.</p>\n";
    addClaims(html, sections);
    for (const Section& section : sections) addSection(html, section);
    html << "<h2>Made by</h2>\n";
    addTable(html, {"",
                    {"what", "which"},
                    {{"program", "palpate " + origins.version + ", commit " + origins.commit},
                     {"libraries", origins.libraries},
                     {"machine", origins.machine},
                     {"plates solved on", origins.solver},
                     {"command", origins.command}}});
    html << "</body></html>\n";
    return html.str();
}

} // namespace palp::report
