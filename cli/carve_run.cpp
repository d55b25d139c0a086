#include "cli/carve_run.h"

#include <fmt/format.h>

#include <utility>

#include <Eigen/Geometry>

#include "cli/pattern_options.h"
#include "cli/report_page.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/pipeline/extruder_palette.h"
#include "core/pipeline/object_settings.h"

namespace fretwork::cli {
namespace {

/// Of the 3D views of a report, all objects together: a megabyte or so.
constexpr std::size_t kViewTriangles = 60000;

CarveInput input_of(const CarveModel& model, CarveTarget& target, const Settings& settings, PictureFiles& pictures) {
    const ChosenExemplar& chosen = exemplar_of(settings, pictures);
    CarveInput input;
    input.mesh = std::move(target.mesh);
    input.triangle_colors = std::move(target.triangle_colors);
    input.model_name = model.file.name;
    input.exemplar = chosen.exemplar;
    input.exemplar_width_mm = chosen.natural_width_mm;
    input.exemplar_name = chosen.name;
    input.named_triangles = target.named_triangles;
    return input;
}

/// What the engine says about a model carries its name, and that of the object where there are several.
template <class Work>
auto naming(const CarveModel& model, const CarveTarget& target, const Work& work) {
    const std::string object = model.targets.size() > 1 ? fmt::format("{}: ", label_of(target)) : "";
    try {
        return work();
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("{}: {}{}", model.file.name, object, error.what()));
    } catch (const MemoryLimit& error) {
        throw MemoryLimit(object + error.what());
    } catch (const ConstraintsNotMet& error) {
        throw ConstraintsNotMet(object + error.what());
    }
}

void warn_of_scale(const CarveTarget& target, RunReport& report) {
    constexpr double slack = 0.01;
    if (target.least_scale > 1.0 - slack && target.most_scale < 1.0 + slack) return;
    const std::string factor = target.most_scale - target.least_scale < slack
                                   ? fmt::format("{:.3g}", target.least_scale)
                                   : fmt::format("{:.3g} to {:.3g}", target.least_scale, target.most_scale);
    report.warnings.push_back(
        fmt::format("the file places the object at {} times its size, and its wall and pattern with it", factor));
}

/// Calls `work(input, settings, its share of the run)` for every target.
template <class Work>
void for_each_target(CarveModel& model, const Settings& settings, PictureFiles& pictures, const RunControl& run,
                     const Work& work) {
    const auto count = static_cast<double>(model.targets.size());
    for (std::size_t i = 0; i < model.targets.size(); ++i) {
        CarveTarget& target = model.targets[i];
        const Settings own = settings_for_object(settings, target.names());
        const auto from = static_cast<double>(i);
        naming(model, target, [&] {
            const CarveInput input = input_of(model, target, own, pictures);
            work(target, input, own, run.slice(from / count, (from + 1.0) / count));
        });
    }
}

}  // namespace

std::string label_of(const CarveTarget& target) {
    return !target.name.empty() || !target.key ? fmt::format("\"{}\"", target.name)
                                               : fmt::format("object {}", target.key->id);
}

std::vector<CarvedTarget> carve_targets(CarveModel& model, const Settings& settings, PictureFiles& pictures,
                                        const RunLimits& limits, KeepViews views, const RunControl& run) {
    const bool trace = views == KeepViews::kYes;
    const double engine = trace ? 0.75 : 1.0;  // its share of the time
    std::vector<CarvedTarget> all;
    for_each_target(model, settings, pictures, run,
                    [&](const CarveTarget& target, const CarveInput& input, const Settings& own, const RunControl& r) {
                        CarveResult result =
                            carve(input, own, limits, r.slice(0.0, engine), trace ? KeepTrace::kYes : KeepTrace::kNo);
                        CarvedTarget& carved = all.emplace_back();
                        if (own.output.voxel_data)
                            carved.sheets = make_voxel_sheets({result.shell, result.solid, result.reinforced,
                                                               result.voxel_colors, result.stress_mpa, result.labels},
                                                              r);
                        if (trace) {
                            const ThreadLimit threads(limits.threads);
                            carved.views = report_views(input.exemplar, result, kViewTriangles / model.targets.size(),
                                                        r.slice(engine, 1.0));
                        }
                        carved.mesh = std::move(result.carved.mesh);
                        carved.triangle_colors = std::move(result.carved.triangle_colors);
                        carved.report = std::move(result.report);
                        warn_of_scale(target, carved.report);
                    });
    return all;
}

void paint_targets(std::vector<CarvedTarget>& carved, const OutputOptions& output) {
    if (output.paint == PaintFormat::kNone) return;
    std::vector<Rgb8> colors;
    std::vector<double> areas;
    for (const CarvedTarget& target : carved) {
        colors.insert(colors.end(), target.triangle_colors.begin(), target.triangle_colors.end());
        if (target.triangle_colors.empty()) continue;
        for (const Triangle& t : target.mesh.triangles) {
            const auto& p = target.mesh.positions_mm;
            areas.push_back(0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm());
        }
    }
    if (colors.empty())
        throw ConstraintsNotMet(
            "output.paint needs colours and output.colour = none leaves none; use exemplar or solid");
    const std::vector<Rgb8> palette = extruder_palette(colors, areas, output.extruders);
    for (CarvedTarget& target : carved) {
        target.extruders = extruders_of(target.triangle_colors, palette);
        target.report.paint = {output.paint, palette};
    }
}

std::vector<RunReport> check_targets(CarveModel& model, const Settings& settings, PictureFiles& pictures,
                                     const RunLimits& limits, const RunControl& run) {
    std::vector<RunReport> all;
    for_each_target(model, settings, pictures, run,
                    [&](const CarveTarget& target, const CarveInput& input, const Settings& own, const RunControl& r) {
                        warn_of_scale(target, all.emplace_back(check_carve(input, own, limits, r)));
                    });
    return all;
}

}  // namespace fretwork::cli
