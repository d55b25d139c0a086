#include "formats/report_strength.h"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "formats/html_text.h"

namespace fretwork {
namespace {

using Cells = std::vector<std::string>;

std::string row(const std::string& head, const Cells& cells) {
    std::string html = fmt::format("<tr><th scope=\"row\">{}</th>", head);
    for (const std::string& cell : cells) html += fmt::format("<td class=\"number\">{}</td>", cell);
    return html + "</tr>\n";
}

std::string table(const char* caption, const std::vector<const char*>& heads, const std::string& rows) {
    std::string html = fmt::format("<div class=\"wide\"><table>\n<caption>{}</caption>\n<thead><tr>", caption);
    for (std::size_t i = 0; i < heads.size(); ++i)
        html += fmt::format("<th scope=\"col\"{}>{}</th>", i == 0 ? "" : " class=\"number\"", heads[i]);
    return html + "</tr></thead>\n<tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string mpa(double pa) {
    return fmt::format("{:.3g}", 1e-6 * pa);
}

std::string case_table(const StrengthReport& report) {
    std::string rows;
    for (const StrengthCase& c : report.cases)
        rows += row(html_escaped(c.name), {fmt::format("{:.3g}", c.least_factor), mpa(c.stress_sum.p99_pa),
                                           mpa(c.max_von_mises_pa), fmt::format("{:.3g}", c.max_displacement_mm)});
    return table("Each load",
                 {"Load", "Factor of safety", "99 % of stress, MPa", "Highest von Mises, MPa", "Moves by, mm"}, rows);
}

std::string weakest_table(const StrengthReport& report) {
    std::string rows;
    for (const WeakPlace& place : report.weakest)
        rows += row(fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", place.at_mm[0], place.at_mm[1], place.at_mm[2]),
                    {fmt::format("{:.3g}", place.factor), mpa(place.von_mises_pa),
                     html_escaped(report.cases[place.load_case].name)});
    return table("Weakest places", {"Where", "Factor of safety", "Von Mises, MPa", "Load"}, rows);
}

std::string round_table(const StrengthRecord& strength) {
    std::string rows;
    for (std::size_t i = 0; i < strength.rounds.size(); ++i) {
        const StrengthRound& round = strength.rounds[i];
        rows += row(i == 0 ? "as carved" : fmt::format("round {}", i),
                    {fmt::format("{:.3g}", round.least_factor), std::to_string(round.weak_voxels),
                     std::to_string(round.voxels_added)});
    }
    return table("Round by round", {"Object", "Factor of safety", "Weak voxels", "Voxels added then"}, rows);
}

}  // namespace

std::string strength_section(const StrengthRecord& strength) {
    const StrengthReport& report = strength.check.report;
    std::string html = fmt::format(
        "<section><h2>Does it hold?</h2>\n<p>{} The full analysis of {} voxels of {:.2g} mm finds a factor of safety "
        "of "
        "{:.3g}; asked is {:.3g}.</p>\n",
        report.holds() ? "Yes." : "Not as asked.", report.voxels, report.voxel_mm, report.least_factor,
        report.safety_factor);
    html += case_table(report) + weakest_table(report) + round_table(strength);
    return html +
           fmt::format("<p class=\"soft\">The rounds ended: {}.</p></section>\n", html_escaped(strength.stopped_by));
}

}  // namespace fretwork
