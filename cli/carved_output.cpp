#include "cli/carved_output.h"

#include <filesystem>

#include "core/pipeline/settings_schema.h"
#include "core/render/render.h"
#include "formats/carved_threemf_writer.h"
#include "formats/png_writer.h"
#include "formats/spec_toml_writer.h"
#include "formats/threemf_reader.h"

namespace fretwork::cli {
namespace {

bool from_threemf(const CarvedModel& result) {
    return result.model.targets.front().key.has_value();
}

/// Without its folder, which is nobody's business and differs from place to place.
std::string file_name_of(const CarveModel& model) {
    return std::filesystem::path(model.file.name).filename().string();
}

/// The result as the build shows it.
MeshFile shown(const CarvedModel& result, const RunControl& run) {
    if (!from_threemf(result)) {
        MeshFile file;
        file.mesh = result.carved.front().mesh;
        file.triangle_colors = result.carved.front().triangle_colors;
        return file;
    }
    std::map<threemf::ObjectKey, MeshToWrite> replaced;
    for (std::size_t i = 0; i < result.carved.size(); ++i)
        replaced.emplace(*result.model.targets[i].key,
                         MeshToWrite{result.carved[i].mesh, result.carved[i].triangle_colors});
    const ModelBytes& file = result.model.file;
    return read_threemf_with(file.bytes, file.name, replaced, run, {result.settings.input.ignore_required});
}

std::string picture_of(const CarvedModel& result, const RenderSettings& settings, const RunControl& run) {
    const MeshFile whole = shown(result, run);
    return write_png(render(whole.mesh, whole.triangle_colors, settings, run));
}

std::string thumbnail(const CarvedModel& result, const RunControl& run) {
    RenderSettings picture;
    picture.width = picture.height = 256;
    picture.samples_per_axis = 2;
    picture.quick = true;
    return picture_of(result, picture, run);
}

std::vector<RunReport> reports_of(const CarvedModel& result) {
    std::vector<RunReport> reports;
    for (const CarvedTarget& carved : result.carved) {
        reports.push_back(carved.report);
        reports.back().input.model = file_name_of(result.model);
    }
    return reports;
}

RunSource source_of(const CarvedModel& result) {
    const ModelBytes& file = result.model.file;
    RunSource source;
    source.version = version();
    source.model = run_file(file_name_of(result.model), file.bytes, result.settings.output.source);
    source.model_format = mesh_format_name(file.format);
    source.model_unit = length_unit_name(file.unit);
    for (const RunFile& materials : result.model.materials)
        source.materials.push_back(run_file(materials.path, materials.bytes, result.settings.output.source));
    source.pictures = result.pictures;
    source.request_toml = write_spec_toml(document_from(result.settings));
    return source;
}

PackageRecord record_of(const CarvedModel& result, const RunControl& run) {
    const RunReport& first = result.carved.front().report;
    PackageRecord record;
    record.metadata = {{"fw:seed", std::to_string(first.seed)}, {"fw:version", first.version}};
    record.spec_toml = write_spec_toml({first.settings, first.regions});
    record.report_json = summary_json(result.model, reports_of(result), ReportTimes::kLeaveOut);
    record.more_parts = parts_of(source_of(result));
    if (result.settings.output.thumbnail) record.thumbnail_png = thumbnail(result, run);
    return record;
}

CarvedObject object_of(const CarvedModel& result, std::size_t i) {
    const CarvedTarget& carved = result.carved[i];
    return {carved.mesh,
            carved.triangle_colors,
            result.model.targets[i].name,
            nullptr,
            carved.sheets ? &*carved.sheets : nullptr,
            {result.settings.output.paint, carved.extruders}};
}

std::string carved_threemf(const CarvedModel& result, const RunControl& run) {
    PackageRecord record = record_of(result, run.slice(0.0, 0.4));
    if (from_threemf(result)) {
        ThreemfEdit edit;
        for (std::size_t i = 0; i < result.carved.size(); ++i)
            edit.objects.push_back({*result.model.targets[i].key, object_of(result, i)});
        edit.record = std::move(record);
        return result.package->write(edit, run.slice(0.4, 1.0));
    }
    CarvedPackage package;
    static_cast<PackageRecord&>(package) = std::move(record);
    package.objects.push_back(object_of(result, 0));
    package.title = title_of(result.model.file);
    package.application = "Fretwork " + version();
    return write_carved_threemf(package, run.slice(0.4, 1.0));
}

}  // namespace

MeshBytes carved_bytes(const CarvedModel& result, const std::string& path, MeshFormat format, const RunControl& run) {
    if (format == MeshFormat::kThreemf) return {carved_threemf(result, run), {}, {}};
    const MeshFile whole = shown(result, run);
    const std::string name = title_of(result.model.file);
    return mesh_bytes(path, {whole.mesh, whole.triangle_colors, name}, format);
}

std::string preview_png(const CarvedModel& result, const RunControl& run) {
    RenderSettings picture;
    if (result.settings.synthesis.preset == Preset::kDraft) {
        picture.width = picture.height = 512;
        picture.samples_per_axis = 2;
        picture.quick = true;
    }
    return picture_of(result, picture, run);
}

std::string summary_json(const CarveModel& model, const std::vector<RunReport>& reports, ReportTimes times) {
    if (!model.targets.front().key) return report_json(reports.front(), times);
    std::vector<ObjectReport> objects;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        const CarveTarget& target = model.targets[i];
        objects.push_back(
            {target.name, target.part_number, target.key->part, target.key->id, target.instances, reports[i]});
    }
    return report_json(objects, times);
}

}  // namespace fretwork::cli
