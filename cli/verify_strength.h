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

namespace fretwork::cli {

struct StrengthOptions {
    std::string spec;               ///< path; empty: the one that a carved 3MF keeps
    std::string material;           ///< empty: that of the spec
    std::optional<int> resolution;  ///< voxels along the longest side
};

void add_strength_flags(CLI::App& command, StrengthOptions& options);

struct StrengthVerdict {
    std::optional<StrengthCheck> check;  ///< none: it could not be made, a caution says why
    std::vector<std::string> faults, cautions;
};

/// Loads, supports and material come from the spec that is named, else from the one that a carved 3MF keeps; with
/// neither, the model stands on its lowest tenth and bears its weight in three directions. Regions are looked for on
/// the model that was carved where the package keeps it, else on `mesh`.
/// \param mesh  of the whole file, repaired
StrengthVerdict verify_strength(const ModelBytes& model, const TriangleMesh& mesh, const MeshReport& report,
                                const StrengthOptions& options, const RunLimits& limits, const RunControl& run);

}  // namespace fretwork::cli
