// The models, patterns and seeds over which the promises of the whole flow are tested.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/carve.h"

namespace fretwork::testing {

struct PropertyModel {
    std::string name;
    TriangleMesh mesh;
    std::size_t parts;  ///< connected components of the surface
    bool open = false;
    int resolution = 48;
    double inradius_mm = 1e9;  ///< of the material, where it is thinner than two walls
};

/// Closed, open, thin, several components, genus above one, sharp and messy.
std::vector<PropertyModel> property_models();

/// The flow on one model with small, quick settings: the wall is 3 voxels, features and holes 2.5.
CarveResult carve_model(const PropertyModel& model, const std::string& pattern, std::uint64_t seed, int threads = 0,
                        const RunControl& run = {});

/// Bodies of a closed mesh: surface components that enclose volume from outside. Cavities do not count.
std::size_t body_count(const TriangleMesh& mesh);

}  // namespace fretwork::testing
