// Named facts for people and programs: `key = value` lines or JSON.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/mesh/mesh_report.h"

namespace fretwork {

struct Facts;

using FactValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>,
                               std::vector<Facts>>;

/// Facts in the order in which they are told. Names of groups stand before a point: "mesh.triangles".
struct Facts {
    std::vector<std::pair<std::string, FactValue>> entries;

    void add(std::string name, FactValue value) { entries.emplace_back(std::move(name), std::move(value)); }
};

/// As facts hold them.
[[nodiscard]] inline std::int64_t fact_count(std::size_t n) {
    return static_cast<std::int64_t>(n);
}
[[nodiscard]] inline std::vector<double> fact_point(const Vec3& p) {
    return {p[0], p[1], p[2]};
}

/// One line per fact; lists of facts are numbered: "parts.0.name = lid".
std::string facts_lines(const Facts& facts);

/// An object; groups become objects. Numbers that are not finite become null.
std::string facts_json(const Facts& facts);

/// A list of objects.
std::string facts_json(const std::vector<Facts>& list);

/// What a mesh is and what is wrong with it, as the group `mesh`.
void add_mesh_facts(const MeshReport& report, Facts& facts);

}  // namespace fretwork
