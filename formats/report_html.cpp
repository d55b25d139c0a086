#include "formats/report_html.h"

#include <fmt/format.h>

#include <filesystem>

#include "formats/html_text.h"
#include "formats/report_assets.h"
#include "formats/report_chart.h"
#include "formats/report_mesh.h"
#include "formats/report_strength.h"
#include "formats/report_tables.h"

namespace fretwork {
namespace {

/// Folders say more about a machine than about the model.
std::string file_name(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

std::string picture(const ReportPicture& p) {
    return fmt::format("<figure><img src=\"{}\" alt=\"{}\"><figcaption><b>{}</b>{}</figcaption></figure>\n",
                       data_uri(p.media_type, p.bytes), html_escaped(p.alt), html_escaped(p.title),
                       html_escaped(p.caption));
}

std::string pictures(const std::vector<ReportPicture>& list) {
    std::string html = "<div class=\"figures\">\n";
    for (const ReportPicture& p : list) html += picture(p);
    return html + "</div>\n";
}

std::string button(const char* shows, const char* label, bool pressed) {
    return fmt::format("<button type=\"button\" data-show=\"{}\" aria-pressed=\"{}\">{}</button>\n", shows, pressed,
                       label);
}

std::string viewer(const ReportMesh& mesh) {
    std::string html =
        "<div class=\"viewer\">\n<canvas tabindex=\"0\" role=\"img\" aria-label=\"The carved model in 3D: "
        "arrow keys turn it, plus and minus zoom, 0 resets\"></canvas>\n<p class=\"nogl\" hidden>This "
        "browser has no WebGL; the pictures below show the same.</p>\n<div class=\"buttons\">\n";
    html += button("pattern", "Pattern", true);
    html += button("bridges", "Bridges", false);
    html += button("before", "Stress before", false);
    html += button("after", "Stress after", false);
    html += button("solid", "Solid", false);
    html +=
        "<button type=\"button\" data-zoom=\"in\" aria-label=\"Zoom in\">+</button>\n"
        "<button type=\"button\" data-zoom=\"out\" aria-label=\"Zoom out\">&minus;</button>\n"
        "<button type=\"button\" data-reset>Reset</button>\n</div>\n<script type=\"application/json\">";
    return html + report_mesh_json(mesh) + "</script>\n</div>\n";
}

std::string warnings(const RunReport& report) {
    if (report.warnings.empty()) return {};
    std::string html = "<section><h2>Warnings</h2>\n<ul>\n";
    for (const std::string& warning : report.warnings) html += "<li>" + html_escaped(warning) + "</li>\n";
    return html + "</ul></section>\n";
}

std::string stress_section(const ReportObject& object) {
    const ShellStress& stress = object.views.stress;
    std::string html = "<section><h2>Stress</h2>\n";
    html += fmt::format(
        "<p class=\"soft\">By {}, in MPa. Before: {}. After: {}. Both have the same loads and the same colours; the "
        "first class of the histogram holds all that is lower, and grey is what nothing is known of.</p>\n",
        html_escaped(stress.name), html_escaped(stress.before_name), html_escaped(stress.after_name));
    html += pictures(object.views.stresses) + stress_legend(stress_scale(stress));
    return html + stress_table(stress) + stress_histogram(stress, stress_scale(stress)) + "</section>\n";
}

std::string iterations_section(const RunReport& report) {
    return fmt::format("<section><h2>Reinforcement, turn by turn</h2>\n<p class=\"soft\">{} The loop ended: {}.</p>\n",
                       report.pattern.reinforced_voxels == 0
                           ? "Nothing had to be added."
                           : fmt::format("{} of {} voxels were made solid.", report.pattern.reinforced_voxels,
                                         report.shell.surface_voxels),
                       html_escaped(report.structure.stopped_by)) +
           iteration_chart(report.iterations) + iteration_table(report.iterations) + "</section>\n";
}

std::string object_html(const ReportObject& object, bool several, ReportTimes times) {
    std::string html;
    if (several) html += fmt::format("<h2 class=\"object\">{}</h2>\n", html_escaped(object.name));
    html += verdicts(object.report) + viewer(object.views.model);
    html += "<section><h2>From example to object</h2>\n" + pictures(object.views.steps) + "</section>\n";
    html += stress_section(object) + iterations_section(object.report);
    if (object.report.strength) html += strength_section(*object.report.strength);
    html += "<div class=\"columns\">\n" + width_section(object.report) + printability_section(object.report) +
            mesh_section(object.report) + pattern_section(object.report) + "</div>\n";
    html += warnings(object.report) + settings_section(object.report);
    if (times == ReportTimes::kInclude) html += times_section(object.report);
    return html;
}

}  // namespace

std::string report_html(std::span<const ReportObject> objects, ReportTimes times) {
    const RunReport& first = objects.front().report;
    const std::string title =
        html_escaped(fmt::format("{} · {}", file_name(first.input.model), file_name(first.input.exemplar)));
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";
    html += fmt::format("<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n", title, kReportStyle);
    html += fmt::format("<header><h1>{}</h1>\n<p class=\"soft\">Carved by Fretwork {} with seed {}.</p></header>\n",
                        title, html_escaped(first.version), first.seed);
    html += "<main>\n";
    for (const ReportObject& object : objects) html += object_html(object, objects.size() > 1, times);
    html += "</main>\n<footer>This page holds everything that it shows and asks nothing of the network.</footer>\n";
    html += fmt::format("<script>\n{}</script>\n</body>\n</html>\n", kReportScript);
    return html;
}

}  // namespace fretwork
