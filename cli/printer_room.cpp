#include "cli/printer_room.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>

#include "formats/cura_definition.h"
#include "formats/read_file.h"

namespace fretwork::cli {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// What the profile says; nothing where it does not.
struct Printer {
    Vec3 room_mm = Vec3::Constant(kNoLimit);  ///< sides of the box that it reaches
    std::optional<double> nozzle_mm;
};

/// "0x0,220x0,220x220,0x220" -> 220 x 220
std::optional<Vec2> bed_of(const std::string& corners) {
    Vec2 low = Vec2::Constant(kNoLimit), high = -low;
    std::istringstream text(corners);
    char between = 0;
    for (double x = 0.0, y = 0.0; text >> x >> between >> y; text >> between) {
        low = low.cwiseMin(Vec2(x, y));
        high = high.cwiseMax(Vec2(x, y));
    }
    const Vec2 size = high - low;
    return size.allFinite() && size.minCoeff() > 0.0 ? std::optional(size) : std::nullopt;
}

std::optional<double> number_of(const std::string& text) {
    std::istringstream stream(text);
    double value = 0.0;
    return stream >> value && value > 0.0 ? std::optional(value) : std::nullopt;
}

Printer printer_of_cura(const std::string& definition) {
    const CuraPrinter cura = read_cura_definition(definition);
    Printer printer;
    if (cura.room_mm) printer.room_mm = (*cura.room_mm)[1] - (*cura.room_mm)[0];
    printer.nozzle_mm = cura.nozzle_mm;
    return printer;
}

Printer printer_of(const std::string& profile) {
    if (profile.ends_with(".def.json")) return printer_of_cura(profile);
    Printer printer;
    std::istringstream lines(read_file(std::filesystem::path(profile)));
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find('=');
        if (equals == line.npos) continue;
        const std::string key = line.substr(0, line.find_last_not_of(" \t", equals - 1) + 1);
        const std::string value = line.substr(equals + 1);
        if (key == "bed_shape") {
            if (const auto bed = bed_of(value)) printer.room_mm.head<2>() = *bed;
        } else if (key == "max_print_height") {
            printer.room_mm[2] = number_of(value).value_or(kNoLimit);
        } else if (key == "nozzle_diameter") {
            printer.nozzle_mm = number_of(value);
        }
    }
    return printer;
}

/// The largest factor at which the box fits, over one where there is room left.
double fitting_scale(const Vec3& room, const Vec3& size) {
    const auto scale = [&](double wide, double deep) { return std::min(room[0] / wide, room[1] / deep); };
    return std::min(std::max(scale(size[0], size[1]), scale(size[1], size[0])), room[2] / size[2]);
}

std::string size_text(const Vec3& mm) {
    const auto side = [](double value) {
        return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("any");
    };
    return fmt::format("{} x {} x {} mm", side(mm[0]), side(mm[1]), side(mm[2]));
}

}  // namespace

std::vector<std::string> printer_warnings(const std::string& profile, const Vec3& size_mm,
                                          const FabricationOptions& fabrication) {
    std::vector<std::string> warnings;
    const Printer printer = printer_of(profile);
    if (const double scale = fitting_scale(printer.room_mm, size_mm); scale < 1.0)
        warnings.push_back(fmt::format("the model is {} and the printer of {} reaches {}; --size-mm {:.4g} fits",
                                       size_text(size_mm), profile, size_text(printer.room_mm),
                                       std::floor(10.0 * scale * size_mm.maxCoeff()) / 10.0));
    if (printer.nozzle_mm && std::abs(*printer.nozzle_mm - fabrication.nozzle_mm) > 0.001)
        warnings.push_back(
            fmt::format("{} has a nozzle of {:g} mm and fabrication.nozzle_mm is {:g}; set one to the other", profile,
                        *printer.nozzle_mm, fabrication.nozzle_mm));
    return warnings;
}

}  // namespace fretwork::cli
