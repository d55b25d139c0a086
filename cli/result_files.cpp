#include "cli/result_files.h"

#include <filesystem>

#include "core/render/render.h"
#include "formats/carved_threemf_writer.h"
#include "formats/png_writer.h"
#include "formats/report_json.h"
#include "formats/spec_toml_writer.h"

namespace fretwork::cli {
namespace {

std::string carved_threemf(const CarveResult& result, const Settings& settings, const CarveInput& input,
                           std::span<const Rgb8> colors, const RunControl& run) {
    CarvedPackage package;
    const VoxelData voxels{result.shell, result.solid, result.reinforced, result.voxel_colors};
    const std::string name = std::filesystem::path(input.model_name).stem().string();
    package.objects.push_back({result.carved.mesh, colors, name, settings.output.voxel_data ? &voxels : nullptr});
    package.title = name;
    package.application = "Fretwork " + result.report.version;
    package.metadata = {{"fw:seed", std::to_string(result.report.seed)}, {"fw:version", result.report.version}};
    package.spec_toml = write_spec_toml({result.report.settings, result.report.regions});
    package.report_json = report_json(result.report, ReportTimes::kLeaveOut);
    return write_carved_threemf(package, run);
}

}  // namespace

MeshBytes carved_bytes(const CarveResult& result, const Settings& settings, const CarveInput& input,
                       const std::string& path, MeshFormat format, const RunControl& run) {
    const std::vector<Rgb8>& colors = result.carved.triangle_colors;
    if (format == MeshFormat::kThreemf) return {carved_threemf(result, settings, input, colors, run), {}, {}};
    const std::string name = std::filesystem::path(input.model_name).stem().string();
    return mesh_bytes(path, {result.carved.mesh, colors, name}, format);
}

}  // namespace fretwork::cli
