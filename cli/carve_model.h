// The model of a run and what of it is carved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/files.h"
#include "core/mesh/region.h"
#include "core/pipeline/settings.h"
#include "formats/threemf_objects.h"

namespace fretwork::cli {

/// A mesh that is carved on its own.
struct CarveTarget {
    std::optional<threemf::ObjectKey> key;  ///< of an object of a 3MF
    std::string name;
    std::string part_number;
    std::size_t instances = 1;
    double least_scale = 1.0, most_scale = 1.0;  ///< by which it is placed
    TriangleMesh mesh;
    std::vector<Rgb8> triangle_colors;
    std::vector<NamedTriangles> named_triangles;  ///< faces and parts that regions may name

    /// Name, number and part number, as far as there are any.
    [[nodiscard]] std::vector<std::string> names() const;
};

struct CarveModel {
    ModelBytes file;
    std::vector<CarveTarget> targets;      ///< at least one
    std::vector<std::string> read_beside;  ///< other files that were read: materials of an OBJ
    std::vector<RunFile> materials;        ///< of an OBJ, by the name of their file, with their bytes
    std::vector<std::string> warnings;
};

/// Reads the model. Of a 3MF, the objects that `input.objects` names, or all that are printed; else all in one.
/// \throws InvalidSetting  a name that no object has; names without a 3MF. Says what there is.
/// \throws InvalidInput    see read_mesh; nothing that is printed.
CarveModel open_model(ModelBytes file, const Settings& settings, const RunControl& run);

}  // namespace fretwork::cli
