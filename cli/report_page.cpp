#include "cli/report_page.h"

#include <cmath>

#include "cli/view_colors.h"
#include "core/pipeline/report_view.h"
#include "core/pipeline/stress_scale.h"
#include "core/render/render.h"
#include "formats/jpeg_writer.h"
#include "formats/png_writer.h"

namespace fretwork::cli {
namespace {

constexpr int kPictureSide = 560;

RenderSettings picture_settings() {
    RenderSettings settings;
    settings.width = settings.height = kPictureSide;
    settings.samples_per_axis = 2;
    settings.quick = true;
    return settings;
}

std::string jpeg_of(const VoxelView& view, const std::vector<Rgb8>& voxel_colors, const RunControl& run) {
    std::vector<Rgb8> colors;
    colors.reserve(view.triangle_voxels.size());
    for (const std::uint32_t v : view.triangle_voxels) colors.push_back(voxel_colors[v]);
    return write_jpeg(render(view.mesh, colors, picture_settings(), run));
}

/// The picture as it tiles, with its holes as paper.
std::string exemplar_png(const Exemplar& exemplar) {
    Image image{exemplar.width, exemplar.height, {}, false};
    for (std::size_t i = 0; i < exemplar.color.size(); ++i) {
        const Rgb8 c = exemplar.solid[i] != 0 ? exemplar.color[i] : Rgb8{255, 255, 255};
        image.pixels.push_back({c[0], c[1], c[2], 255});
    }
    return write_png(image);
}

std::vector<std::uint8_t> bridges(const CarveResult& carved) {
    std::vector<std::uint8_t> bridge(carved.shell.size(), 0);
    for (std::size_t v = 0; v < bridge.size(); ++v)
        bridge[v] = carved.reinforced[v] != 0 && carved.solid[v] == SolidState::kSolid &&
                            carved.trace->first_solid[v] == SolidState::kEmpty
                        ? 1
                        : 0;
    return bridge;
}

std::vector<Rgb8> stress_colors(const StressField& field, const StressScale& scale) {
    std::vector<Rgb8> colors;
    colors.reserve(field.voxel_mpa.size());
    for (const float mpa : field.voxel_mpa)
        colors.push_back(mpa < 0.0F ? kNotKnown : stress_color(scale.place(static_cast<double>(mpa))));
    return colors;
}

/// Solid where stress is known: the pattern that was analysed.
SolidStates analysed(const StressField& field) {
    SolidStates solid;
    solid.reserve(field.voxel_mpa.size());
    for (const float mpa : field.voxel_mpa) solid.push_back(mpa < 0.0F ? SolidState::kEmpty : SolidState::kSolid);
    return solid;
}

std::vector<std::uint8_t> stress_bytes(const StressField& field, const StressScale& scale, const VoxelView& view) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(view.triangle_voxels.size());
    for (const std::uint32_t v : view.triangle_voxels) {
        const double mpa = static_cast<double>(field.voxel_mpa[v]);
        bytes.push_back(mpa < 0.0 ? std::uint8_t{0}
                                  : static_cast<std::uint8_t>(1 + std::lround(254.0 * scale.place(mpa))));
    }
    return bytes;
}

ReportMesh model_mesh(const CarveResult& carved, const std::vector<std::uint8_t>& bridge, std::size_t most_triangles,
                      const RunControl& run) {
    LightView light = light_view(carved.carved, carved.shell.grid.voxel_mm, most_triangles, kPlain, run);
    VoxelView& view = light.view;
    const StressScale scale = stress_scale(carved.trace->stress);
    ReportMesh model;
    for (const std::uint32_t v : view.triangle_voxels) model.bridge.push_back(bridge[v]);
    model.vertex_colors = std::move(light.vertex_colors);
    model.stress_before = stress_bytes(carved.trace->stress.before, scale, view);
    model.stress_after = stress_bytes(carved.trace->stress.after, scale, view);
    model.mesh = std::move(view.mesh);
    return model;
}

std::vector<Rgb8> bridge_colors(const std::vector<std::uint8_t>& bridge) {
    std::vector<Rgb8> colors;
    colors.reserve(bridge.size());
    for (const std::uint8_t b : bridge) colors.push_back(b != 0 ? kBridge : kPlain);
    return colors;
}

}  // namespace

ReportViews report_views(const Exemplar& exemplar, const CarveResult& carved, std::size_t most_triangles,
                         const RunControl& run) {
    const CarveTrace& trace = *carved.trace;
    const VoxelView surface = fine_surface(carved.surface, carved.shell, run.slice(0.0, 0.1));
    const std::vector<std::uint8_t> bridge = bridges(carved);
    const StressScale scale = stress_scale(trace.stress);
    ReportViews views;
    const auto picture = [&](const SolidStates& solid, const std::vector<Rgb8>& colors, double from) {
        return jpeg_of(solid_part(surface, solid), colors, run.slice(from, from + 0.1));
    };
    views.steps.push_back(
        {"image/png", exemplar_png(exemplar), "Example", "What the object is to look like.", "The example picture"});
    views.steps.push_back({"image/jpeg", picture(trace.first_solid, trace.first_colors, 0.1), "First synthesis",
                           "The pattern before anything was added for strength.",
                           "The object with the pattern of the first synthesis"});
    views.steps.push_back({"image/jpeg", picture(carved.solid, bridge_colors(bridge), 0.2), "Bridges",
                           "Orange: what reinforcement made solid.", "The object with its bridges in orange"});
    views.steps.push_back(
        {"image/jpeg",
         write_jpeg(render(carved.carved.mesh, carved.carved.triangle_colors, picture_settings(), run.slice(0.3, 0.4))),
         "Carved", "The final pattern with its wall.", "The carved object"});
    views.stresses.push_back({"image/jpeg",
                              picture(analysed(trace.stress.before), stress_colors(trace.stress.before, scale), 0.4),
                              "Stress before", "Pieces joined, nothing else reinforced.",
                              "The object coloured by stress before reinforcement"});
    views.stresses.push_back(
        {"image/jpeg", picture(analysed(trace.stress.after), stress_colors(trace.stress.after, scale), 0.5),
         "Stress after", "The reinforced pattern.", "The object coloured by stress after reinforcement"});
    views.model = model_mesh(carved, bridge, most_triangles, run.slice(0.6, 1.0));
    views.stress = trace.stress;
    return views;
}

std::string report_page(const CarveModel& model, const std::vector<CarvedTarget>& carved,
                        const std::vector<RunReport>& reports) {
    std::vector<ReportObject> objects;
    for (std::size_t i = 0; i < carved.size(); ++i)
        objects.push_back({label_of(model.targets[i]), reports[i], *carved[i].views});
    return report_html(objects);
}

}  // namespace fretwork::cli
