#include "core/strength/strength_faults.h"

#include <fmt/format.h>

namespace fretwork {

std::vector<std::string> strength_faults(const StrengthReport& report) {
    if (report.holds() || report.weakest.empty()) return {};
    const WeakPlace& weakest = report.weakest.front();
    const char* outcome = weakest.factor < 1.0 ? "breaks" : "is too weak";
    return {fmt::format("{} under \"{}\" at ({:.2f}, {:.2f}, {:.2f}) mm: factor of safety {:.3g}, asked is {:.3g}",
                        outcome, report.cases[weakest.load_case].name, weakest.at_mm[0], weakest.at_mm[1],
                        weakest.at_mm[2], weakest.factor, report.safety_factor)};
}

std::vector<std::string> strength_cautions(const StrengthReport& report) {
    std::vector<std::string> cautions;
    if (report.pieces > 1)
        cautions.push_back(fmt::format("{} pieces of voxels lie apart; each is held on its own", report.pieces));
    // A wall of several voxels has no hinges.
    if (report.joining_voxels * 1000 > report.voxels)
        cautions.push_back(
            fmt::format("{} voxels of {:.3g} mm had to be added to join strands thinner than a voxel; a "
                        "finer resolution tells more",
                        report.joining_voxels, report.voxel_mm));
    return cautions;
}

}  // namespace fretwork
