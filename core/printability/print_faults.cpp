#include "core/printability/print_faults.h"

#include <fmt/format.h>

namespace fretwork {
namespace {

/// Less does not stick to a bed, whatever the printer.
constexpr double kLeastContactMm2 = 1.0;

std::string place_of(const PrintPlace& place) {
    return fmt::format("at ({:.1f}, {:.1f}, {:.1f}) mm", place.at_mm[0], place.at_mm[1], place.at_mm[2]);
}

}  // namespace

std::vector<std::string> print_faults(const PrintabilityReport& report, double nozzle_mm) {
    std::vector<std::string> faults;
    if (report.loose_parts > 0)
        faults.push_back(fmt::format("{} loose {}", report.loose_parts, report.loose_parts == 1 ? "part" : "parts"));
    if (report.empty_layers > 0)
        faults.push_back(fmt::format("{} of {} layers are empty", report.empty_layers, report.layers));
    if (report.first_layer_contact_mm2 < kLeastContactMm2)
        faults.push_back(fmt::format("only {:.2g} mm2 stand on the bed", report.first_layer_contact_mm2));
    if (report.least_solid && report.least_solid->size_mm < nozzle_mm)
        faults.push_back(fmt::format("a strand is {:.2f} mm wide {}, and a printed line is {:g} mm",
                                     report.least_solid->size_mm, place_of(*report.least_solid), nozzle_mm));
    return faults;
}

std::vector<std::string> print_cautions(const PrintabilityReport& report) {
    std::vector<std::string> cautions;
    if (report.islands > 0)
        cautions.push_back(fmt::format("{} places begin in the air, the largest {}: print with supports",
                                       report.islands, place_of(report.island_places.front())));
    if (report.closed_cavities > 0)
        cautions.push_back(
            fmt::format("{} hollows have no way out: resin and powder stay inside", report.closed_cavities));
    return cautions;
}

}  // namespace fretwork
