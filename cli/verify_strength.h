// `verify`: does the model hold, under the loads that its spec names?
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/files.h"
#include "core/mesh/mesh_report.h"
#include "core/pipeline/carve.h"
#include "core/pipeline/strength_check.h"
#include "core/pipeline/stress_scale.h"

namespace fretwork::cli {

struct StrengthOptions {
    std::string spec;               ///< path; empty: the one that a carved 3MF keeps
    std::string material;           ///< empty: that of the spec
    std::optional<int> resolution;  ///< voxels along the longest side
    std::string stress_output;      ///< path of a mesh in the colours of its stress; empty: none
};

void add_strength_flags(CLI::App& command, StrengthOptions& options);

/// What was judged on its own.
struct JudgedBody {
    std::string label;                        ///< as messages call it; empty: the only one
    StrengthCheck check;                      ///< its report alone
    std::optional<StressScale> stress_scale;  ///< of the mesh in the colours of its stress, where one was asked for
    std::vector<std::string> faults;
};

struct StrengthVerdict {
    std::vector<JudgedBody> bodies;             ///< fewer where a check could not be made, a caution says why
    std::vector<std::string> faults, cautions;  ///< of all, with the labels
};

/// The body that is nearest to breaking, of those that were asked for. \param bodies  at least one
const JudgedBody& weakest_of(const std::vector<JudgedBody>& bodies);

/// Loads, supports and material come from the spec that is named, else from the one that a carved 3MF keeps; with
/// neither, the model stands on its lowest tenth and bears its weight in three directions. Carved objects of a 3MF are
/// judged one by one, each by its own settings (`[[object]]`). Regions are looked for on the model that was carved
/// where the package keeps it, else on the carved surface.
/// \param mesh  of the whole file, repaired
/// \throws InvalidSetting  `stress_output` for more than one body. \throws FileError  it cannot be written
StrengthVerdict verify_strength(const ModelBytes& model, const TriangleMesh& mesh, const MeshReport& report,
                                const StrengthOptions& options, const RunLimits& limits, const RunControl& run);

}  // namespace fretwork::cli
