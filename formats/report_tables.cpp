#include "formats/report_tables.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "formats/html_text.h"

namespace fretwork {
namespace {

/// A table of names and values.
class FactTable {
  public:
    explicit FactTable(std::string caption) : caption_(std::move(caption)) {}

    void add(const char* name, const std::string& value) {
        rows_ += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td></tr>\n", name, value);
    }
    void add(const char* name, std::size_t count) { add(name, std::to_string(count)); }
    void add_mm(const char* name, double mm) { add(name, fmt::format("{:.3g} mm", mm)); }

    [[nodiscard]] std::string html() const {
        return fmt::format(
            "<section><h2>{}</h2>\n<table>\n<thead><tr><th scope=\"col\">What</th><th scope=\"col\" "
            "class=\"number\">Found</th></tr></thead>\n<tbody>\n{}</tbody></table></section>\n",
            caption_, rows_);
    }

  private:
    std::string caption_, rows_;
};

std::string chip(bool good, const std::string& text) {
    return fmt::format("<li class=\"{}\">{}</li>\n", good ? "good" : "bad", html_escaped(text));
}

std::string percent(double share) {
    return fmt::format("{:.1f} %", 100.0 * share);
}

std::string change(double before, double after) {
    if (!(before > 0.0)) return "–";
    const double percent = std::round(100.0 * (after / before - 1.0));
    return percent == 0.0 ? "0 %" : fmt::format("{:+.0f} %", percent);
}

std::string place(const std::optional<PrintPlace>& found, double asked_mm) {
    return found ? fmt::format("{:.2f} mm", found->size_mm) : fmt::format("over {:.2f} mm", asked_mm);
}

}  // namespace

std::string verdicts(const RunReport& report) {
    const MeshReport& mesh = report.mesh.report;
    const std::size_t pieces = report.pattern.components_after;
    std::string html = "<ul class=\"chips\">\n";
    html += chip(pieces == report.shell.components,
                 pieces == 1 ? "one piece" : fmt::format("{} pieces for {} parts", pieces, report.shell.components));
    const bool valid = mesh.closed_manifold() && mesh.non_manifold_vertices == 0 && mesh.self_intersections == 0;
    html += chip(valid, valid ? "valid mesh" : "the mesh has faults");
    if (report.strength)
        html += chip(report.strength->faults.empty(),
                     fmt::format("factor of safety {:.3g}, asked is {:.3g}", report.strength->check.report.least_factor,
                                 report.strength->check.report.safety_factor));
    else
        html += chip(report.structure.max_pa <= report.structure.allowable_pa, report.structure.verdict);
    if (report.print)
        html +=
            chip(report.print->faults.empty(),
                 report.print->faults.empty() ? "prints" : fmt::format("{} print faults", report.print->faults.size()));
    return html + "</ul>\n";
}

std::string stress_table(const ShellStress& stress) {
    const StressFigures before = stress_figures(stress.before.samples_mpa);
    const StressFigures after = stress_figures(stress.after.samples_mpa);
    std::string html = fmt::format(
        "<div class=\"wide\"><table>\n<caption>Stress in MPa over {}; {:.3g} MPa are allowed</caption>\n<thead><tr><th "
        "scope=\"col\">Figure</th><th scope=\"col\" class=\"number\">Before</th><th scope=\"col\" "
        "class=\"number\">After</th><th scope=\"col\" class=\"number\">Change</th></tr></thead>\n<tbody>\n",
        html_escaped(stress.sample_name), stress.allowable_mpa);
    const auto row = [&](const char* name, double b, double a) {
        html += fmt::format(
            "<tr><th scope=\"row\">{}</th><td class=\"number\">{:.3g}</td><td class=\"number\">{:.3g}"
            "</td><td class=\"number\">{}</td></tr>\n",
            name, b, a, change(b, a));
    };
    row("Average", before.average_mpa, after.average_mpa);
    row("Median", before.median_mpa, after.median_mpa);
    row("99th percentile", before.p99_mpa, after.p99_mpa);
    row("Highest", before.max_mpa, after.max_mpa);
    return html + "</tbody></table></div>\n";
}

std::string iteration_table(const std::vector<ReinforceRecord>& turns) {
    std::string html = "<details><summary>All turns in figures</summary>\n<div class=\"wide\"><table>\n<thead><tr>";
    for (const char* head : {"Turn", "Pieces", "Bridges to connect", "against stress", "against long ways",
                             "Voxels added", "99 % of stress, MPa", "Highest, MPa"})
        html += fmt::format("<th scope=\"col\" class=\"number\">{}</th>", head);
    html += "</tr></thead>\n<tbody>\n";
    for (const ReinforceRecord& t : turns) {
        html += fmt::format("<tr><th scope=\"row\" class=\"number\">{}</th>", t.iteration);
        for (const std::size_t count :
             {t.components_before, t.bridges_connect, t.bridges_stress, t.bridges_geodesic, t.voxels_added})
            html += fmt::format("<td class=\"number\">{}</td>", count);
        html += fmt::format("<td class=\"number\">{:.3g}</td><td class=\"number\">{:.3g}</td></tr>\n",
                            1e-6 * t.p99_score_pa, 1e-6 * t.max_score_pa);
    }
    return html + "</tbody></table></div></details>\n";
}

std::string width_section(const RunReport& report) {
    FactTable table("Widths");
    table.add_mm("Wall", report.shell.thickness_mm);
    table.add_mm("Strands, asked for at least", report.mesh.min_feature_mm);
    table.add_mm("Holes, asked for at least", report.mesh.min_hole_mm);
    if (report.print) {
        const PrintabilityReport& p = report.print->report;
        table.add("Thinnest solid", place(p.least_solid, report.mesh.min_feature_mm));
        table.add("Narrowest gap", place(p.least_hole, report.mesh.min_hole_mm));
        table.add("Surface with thinner solid", percent(p.thin_share));
        table.add("Surface with narrower gaps", percent(p.narrow_share));
    }
    table.add_mm("Voxel", report.shell.voxel_mm);
    return table.html();
}

std::string printability_section(const RunReport& report) {
    if (!report.print)
        return "<section><h2>Printability</h2>\n<p class=\"soft\">A draft is not looked at layer by layer; the full "
               "run "
               "is.</p></section>\n";
    const PrintabilityReport& p = report.print->report;
    FactTable table("Printability");
    table.add("Layers", fmt::format("{} of {:.2g} mm", p.layers, p.layer_height_mm));
    table.add("Material", fmt::format("{:.1f} cm³", 1e-3 * p.material_mm3));
    table.add("Contact with the bed", fmt::format("{:.1f} mm²", p.first_layer_contact_mm2));
    table.add("Islands, which ask for supports", p.islands);
    table.add("Overhanging area", fmt::format("{:.0f} mm²", p.overhang_area_mm2));
    table.add_mm("Longest bridge", p.longest_bridge.size_mm);
    table.add_mm("Longest cantilever", p.longest_cantilever.size_mm);
    table.add("Loose parts", p.loose_parts);
    table.add("Closed hollows", p.closed_cavities);
    for (const std::string& fault : report.print->faults) table.add("Fault", html_escaped(fault));
    return table.html();
}

std::string mesh_section(const RunReport& report) {
    const MeshReport& m = report.mesh.report;
    FactTable table("Mesh");
    const Vec3 size = m.max_mm - m.min_mm;
    table.add("Size", fmt::format("{:.1f} × {:.1f} × {:.1f} mm", size[0], size[1], size[2]));
    table.add("Volume", fmt::format("{:.2f} cm³", 1e-3 * m.volume_mm3));
    table.add("Triangles", m.triangles);
    table.add("Shells", m.components);
    table.add("Open edges", m.border_edges);
    table.add("Edges of more than two triangles", m.non_manifold_edges);
    table.add("Self-intersections",
              m.self_intersections_counted ? std::to_string(m.self_intersections) : std::string("not counted"));
    table.add("Degenerate triangles", m.degenerate_triangles);
    return table.html();
}

std::string pattern_section(const RunReport& report) {
    const PatternRecord& p = report.pattern;
    FactTable table("Pattern");
    table.add("Solid, of the example", percent(p.exemplar_solid_fraction));
    table.add("Solid, of the object", percent(p.solid_fraction));
    table.add_mm("Width of the example", p.exemplar_width_mm);
    table.add("Surface voxels", report.shell.surface_voxels);
    table.add("Pieces of the first synthesis", p.components_before);
    table.add("Pieces in the end", p.components_after);
    table.add("Voxels reinforced", p.reinforced_voxels);
    table.add("Voxels added for width", p.voxels_enlarged);
    table.add("Voxels kept solid", p.kept_voxels);
    return table.html();
}

std::string settings_section(const RunReport& report) {
    std::string html =
        "<section><h2>Settings</h2>\n<details><summary>Every setting as it was used</summary>\n<table>\n"
        "<thead><tr><th scope=\"col\">Setting</th><th scope=\"col\">Value</th></tr></thead>\n<tbody>\n";
    const auto row = [&](const std::string& key, const SettingValue& value) {
        html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", html_escaped(key),
                            html_escaped(setting_text(value)));
    };
    for (const SettingAssignment& a : report.settings) row(a.key, a.value);
    for (const SettingTable& table : report.regions)
        for (const SettingAssignment& a : table.entries) row("[[" + table.array + "]] " + a.key, a.value);
    return html + "</tbody></table></details></section>\n";
}

std::string times_section(const RunReport& report) {
    std::string html =
        "<section class=\"times\"><h2>Time</h2>\n<table>\n<thead><tr><th scope=\"col\">Stage</th><th "
        "scope=\"col\" class=\"number\">Seconds</th></tr></thead>\n<tbody>\n";
    for (const StageSeconds& stage : report.seconds)
        html += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"number\">{:.2f}</td></tr>\n",
                            html_escaped(stage.stage), stage.seconds);
    html +=
        fmt::format("<tr><th scope=\"row\">total</th><td class=\"number\">{:.2f}</td></tr>\n", report.seconds_total);
    return html + fmt::format("</tbody></table>\n<p class=\"soft\">Memory at the peak: {:.0f} MB.</p></section>\n",
                              static_cast<double>(report.peak_memory_bytes) / 1e6);
}

}  // namespace fretwork
