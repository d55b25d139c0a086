// Meshes that the tests of the shell go through.
#pragma once

#include <string>
#include <vector>

#include "support/make_meshes.h"

namespace fretwork::testing {

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

inline std::vector<NamedMesh> assorted_meshes() {
    return {{"sphere", make_icosphere(10, 3)},
            {"torus", make_torus(10, 3, 40, 20)},
            {"box of twelve triangles", rotated(make_box({0, 0, 0}, {10, 7, 5}), Vec3(1, 2, 3).normalized(), 0.7)},
            {"bracket", make_bracket()},
            {"frame", make_frame(20, 3)},
            {"thin plate", make_thin_plate(20, 15, 0.3)},
            {"thin tube", make_tube(10, 9.8, 12, 64)},
            {"open bowl", make_open_bowl(10, 12, 24)},
            {"linked tori", make_linked_tori(10, 3)},
            {"nested spheres", make_nested_spheres(10, 9)},
            {"two boxes on one edge", make_boxes_sharing_edge()},
            {"pinched vertex", make_pinched_vertex()},
            {"three fins", make_three_fins()},
            {"degenerate triangles", with_degenerates(make_icosphere(10, 2), 9)},
            {"duplicate triangles", with_duplicates(make_icosphere(10, 2), 40)},
            {"soup", random_soup(3, 30, 20)}};
}

}  // namespace fretwork::testing
