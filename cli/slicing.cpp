#include "cli/slicing.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "cli/child_process.h"
#include "cli/files.h"
#include "core/base/error.h"
#include "formats/cura_definition.h"
#include "formats/gcode_reader.h"
#include "formats/mesh_file.h"
#include "formats/read_file.h"
#include "formats/scratch_folder.h"
#include "formats/sla_reader.h"

namespace fretwork::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kUsualLineMm = 0.45;
constexpr double kSlackMm = 0.01;

enum class Slicer { kPrusaFilament, kPrusaResin, kCura };

Slicer slicer_of(const std::string& profile) {
    if (profile.ends_with(".def.json")) return Slicer::kCura;
    if (!profile.ends_with(".ini"))
        throw InvalidSetting(
            fmt::format("--slice {}: expected a profile of PrusaSlicer (.ini) or a definition of CuraEngine "
                        "(.def.json)",
                        profile));
    std::istringstream lines(read_file(fs::path(profile)));
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("printer_technology") && line.find("SLA") != line.npos) return Slicer::kPrusaResin;
    return Slicer::kPrusaFilament;
}

const char* program_of(Slicer slicer) {
    return slicer == Slicer::kCura ? "CuraEngine" : "prusa-slicer";
}

std::vector<std::string> prusa_line(Slicer slicer, const std::string& profile, const std::string& out,
                                    const std::string& model) {
    return {program_of(slicer),
            slicer == Slicer::kPrusaResin ? "--export-sla" : "--export-gcode",
            "--load",
            profile,
            "-o",
            out,
            model};
}

/// CuraEngine reads STL only, and finds what a definition builds on beside it.
std::vector<std::string> cura_line(const std::string& profile, const std::string& out, const std::string& stl) {
    return {program_of(Slicer::kCura), "slice", "-v", "-j", profile, "-s", "center_object=true", "-o", out, "-l", stl};
}

std::vector<std::string> cura_environment(const std::string& profile) {
    const fs::path definitions = fs::absolute(profile).parent_path();
    return {fmt::format("CURA_ENGINE_SEARCH_PATH={}:{}", definitions.string(),
                        (definitions.parent_path() / "extruders").string())};
}

std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (line.find_first_not_of(" \t\r") != line.npos) last = line;
    return last;
}

/// What the slicer says and does not fail for.
std::vector<std::string> warnings_in(const std::string& text) {
    std::vector<std::string> warnings;
    std::istringstream lines(text);
    constexpr std::string_view kMark = "print warning: ";
    for (std::string line; std::getline(lines, line);)
        if (const auto at = line.find(kMark); at != line.npos) warnings.push_back(line.substr(at + kMark.size()));
    return warnings;
}

/// CuraEngine's totals stand in what it says; those in its G-code are placeholders. The printer's size stands in
/// neither.
void add_cura_facts(const std::string& text, const std::string& definition, SlicedPrint& print) {
    const auto after = [&](const std::string& mark) -> std::optional<double> {
        const auto at = text.rfind(mark);
        if (at == text.npos) return std::nullopt;
        return std::strtod(text.c_str() + at + mark.size(), nullptr);
    };
    print.seconds = after("Print time (s): ");
    if (const auto mm3 = after("Filament (mm^3): ")) print.material_ml = *mm3 / 1000.0;
    if (const auto meters = after(";Filament used: ")) print.filament_mm = *meters * 1000.0;
    print.room_mm = read_cura_definition(definition).room_mm;
}

void judge_bed(const SlicedPrint& print, std::vector<std::string>& faults) {
    if (!print.room_mm) return;
    const auto& [low, high] = *print.room_mm;
    const Vec3 slack = Vec3::Constant(kSlackMm);
    if (((print.min_mm + slack).array() >= low.array()).all() && ((print.max_mm - slack).array() <= high.array()).all())
        return;
    faults.push_back(
        fmt::format("it is printed from ({:.1f}, {:.1f}, {:.1f}) to ({:.1f}, {:.1f}, {:.1f}) mm, and the "
                    "printer reaches from ({:g}, {:g}) to ({:g}, {:g}) and {:g} mm high",
                    print.min_mm[0], print.min_mm[1], print.min_mm[2], print.max_mm[0], print.max_mm[1],
                    print.max_mm[2], low[0], low[1], high[0], high[1], high[2]));
}

void judge_gaps(const SlicedPrint& print, std::vector<std::string>& faults) {
    if (print.empty_between_mm.empty()) return;
    const Vec2& first = print.empty_between_mm.front();
    faults.push_back(fmt::format("nothing is printed between {:g} and {:g} mm{}", first[0], first[1],
                                 print.empty_between_mm.size() > 1
                                     ? fmt::format(", nor at {} more heights", print.empty_between_mm.size() - 1)
                                     : ""));
}

void judge_parts(const SlicedPrint& print, const TriangleMesh& mesh, const RunControl& run, SliceRecord& record) {
    const double line = print.line_mm.value_or(kUsualLineMm);
    const LostParts lost = find_lost_parts(mesh, print.layers, line, run);
    record.parts_compared = lost.compared;
    record.lost_parts = lost.places.size();
    if (lost.places.empty()) return;
    const Vec3& at = lost.places.front().at_mm;
    record.faults.push_back(fmt::format("no line is printed in {} {} layers, first at ({:.1f}, {:.1f}, {:.1f}) mm",
                                        lost.places.size(), lost.places.size() == 1 ? "part of the" : "parts of", at[0],
                                        at[1], at[2]));
}

SliceRecord record_of(const SlicedPrint& print) {
    SliceRecord record;
    record.layers = print.layers.size();
    record.height_mm = print.layers.empty() ? 0.0 : print.layers.back().top_mm;
    record.seconds = print.seconds;
    record.filament_mm = print.filament_mm;
    record.filament_g = print.filament_g;
    record.material_ml = print.material_ml;
    judge_gaps(print, record.faults);
    judge_bed(print, record.faults);
    return record;
}

const char* ending_of(Slicer slicer) {
    return slicer == Slicer::kPrusaResin ? ".sl1" : ".gcode";
}

/// What the slicer has said; its result lies at `out` then.
std::string run_slicer(Slicer slicer, const std::string& model, const std::string& profile, const fs::path& out,
                       const ScratchFolder& folder, const RunControl& run) {
    ProcessResult said;
    if (slicer == Slicer::kCura) {
        const fs::path stl = folder / "model.stl";
        write_mesh(stl, {read_mesh(fs::path(model)).mesh});
        said = run_process(cura_line(profile, out.string(), stl.string()), run, cura_environment(profile));
    } else {
        said = run_process(prusa_line(slicer, profile, out.string(), model), run);
    }
    std::error_code none;
    const std::string text = said.out + said.err;
    if (said.exit_code != 0 || !fs::exists(out, none))
        throw InvalidInput(fmt::format("{}: {} made nothing of it with {}: exit code {}{}{}", model, program_of(slicer),
                                       profile, said.exit_code, text.empty() ? "" : ", ", last_line(text)));
    return text;
}

}  // namespace

std::string sliced_path(const std::string& model, const std::string& profile) {
    return fs::path(model).replace_extension(ending_of(slicer_of(profile))).string();
}

std::vector<std::string> profile_files(const std::string& profile) {
    if (slicer_of(profile) != Slicer::kCura) return {profile};
    std::vector<std::string> files;
    for (const fs::path& file : read_cura_definition(profile).files) files.push_back(file.string());
    return files;
}

Slicing slice(const std::string& model, const std::string& profile, const RunControl& run) {
    const Slicer slicer = slicer_of(profile);
    const bool resin = slicer == Slicer::kPrusaResin;
    const ScratchFolder folder;
    const fs::path out = folder / (std::string("out") + ending_of(slicer));
    const std::string said = run_slicer(slicer, model, profile, out, folder, run);
    Slicing result;
    result.bytes = read_file(out);
    const std::string source = fs::path(model).replace_extension(ending_of(slicer)).string();
    SlicedPrint print = resin ? read_sla_archive(result.bytes, source) : read_gcode(result.bytes, source);
    if (slicer == Slicer::kCura) add_cura_facts(said, profile, print);
    result.record = record_of(print);
    result.record.slicer = program_of(slicer);
    result.record.profile = profile;
    result.record.output = source;
    result.record.warnings = warnings_in(said);
    if (!resin) judge_parts(print, read_mesh(fs::path(model)).mesh, run, result.record);
    return result;
}

}  // namespace fretwork::cli
