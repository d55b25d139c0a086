#include "formats/facts_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace fretwork {
namespace {

using Json = nlohmann::ordered_json;

Json object_of(const Facts& facts);

struct ToJson {
    Json operator()(double number) const { return std::isfinite(number) ? Json(number) : Json(nullptr); }
    Json operator()(const std::vector<double>& numbers) const {
        Json list = Json::array();
        for (const double number : numbers) list.push_back((*this)(number));
        return list;
    }
    Json operator()(const std::vector<Facts>& many) const {
        Json list = Json::array();
        for (const Facts& facts : many) list.push_back(object_of(facts));
        return list;
    }
    template <class Plain>
    Json operator()(const Plain& value) const {
        return value;
    }
};

Json object_of(const Facts& facts) {
    Json object = Json::object();
    for (const auto& [name, value] : facts.entries) {
        Json* place = &object;
        std::string_view rest = name;
        for (auto dot = rest.find('.'); dot != rest.npos; dot = rest.find('.')) {
            place = &(*place)[std::string(rest.substr(0, dot))];
            rest.remove_prefix(dot + 1);
        }
        (*place)[std::string(rest)] = std::visit(ToJson{}, value);
    }
    return object;
}

std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void add_lines(const Json& json, const std::string& prefix, std::string& out) {
    for (const auto& [key, value] : json.items()) {
        const bool nested = value.is_object() || (value.is_array() && !value.empty() && value.front().is_object());
        if (nested)
            add_lines(value, fmt::format("{}{}.", prefix, key), out);
        else
            out += fmt::format("{}{} = {}\n", prefix, key,
                               value.is_string() ? value.get<std::string>()
                                                 : value.dump(-1, ' ', false, Json::error_handler_t::replace));
    }
}

}  // namespace

std::string facts_lines(const Facts& facts) {
    std::string out;
    add_lines(object_of(facts), "", out);
    return out;
}

std::string facts_json(const Facts& facts) {
    return text_of(object_of(facts));
}

std::string facts_json(const std::vector<Facts>& list) {
    return text_of(ToJson{}(list));
}

void add_mesh_facts(const MeshReport& m, Facts& facts) {
    const auto count = [&](const char* name, std::size_t value) {
        facts.add(std::string("mesh.").append(name), static_cast<std::int64_t>(value));
    };
    const auto corner = [](const Vec3& v) { return std::vector<double>{v[0], v[1], v[2]}; };
    count("vertices", m.vertices);
    count("triangles", m.triangles);
    facts.add("mesh.min_mm", corner(m.min_mm));
    facts.add("mesh.max_mm", corner(m.max_mm));
    facts.add("mesh.area_mm2", m.area_mm2);
    facts.add("mesh.volume_mm3", m.volume_mm3);
    facts.add("mesh.closed", m.border_edges == 0);
    facts.add("mesh.manifold", m.closed_manifold() && m.non_manifold_vertices == 0);
    count("components", m.components);
    count("border_edges", m.border_edges);
    count("non_manifold_edges", m.non_manifold_edges);
    count("non_manifold_vertices", m.non_manifold_vertices);
    count("flipped_edges", m.flipped_edges);
    count("degenerate_triangles", m.degenerate_triangles);
    count("duplicate_triangles", m.duplicate_triangles);
    if (m.self_intersections_counted) count("self_intersections", m.self_intersections);
}

}  // namespace fretwork
