#include "formats/printability_facts.h"

namespace fretwork {
namespace {

/// Only what was found has a place.
void add_place(const std::string& name, const PrintPlace& place, Facts& facts) {
    facts.add(name + "_mm", place.size_mm);
    if (place.size_mm > 0.0) facts.add(name + "_at_mm", fact_point(place.at_mm));
}

std::vector<Facts> layers_with_islands(const PrintabilityReport& report) {
    std::vector<Facts> layers;
    for (std::size_t i = 0; i < report.islands_per_layer.size(); ++i)
        if (report.islands_per_layer[i] > 0)
            layers.push_back({{{"layer", fact_count(i)}, {"islands", fact_count(report.islands_per_layer[i])}}});
    return layers;
}

std::vector<Facts> island_places(const PrintabilityReport& report) {
    std::vector<Facts> places;
    for (const PrintPlace& place : report.island_places)
        places.push_back({{{"at_mm", fact_point(place.at_mm)}, {"size_mm", place.size_mm}}});
    return places;
}

}  // namespace

void add_printability_facts(const PrintabilityReport& report, const std::vector<std::string>& faults,
                            const std::string& group, Facts& facts) {
    facts.add(group + "layer_height_mm", report.layer_height_mm);
    facts.add(group + "layers", fact_count(report.layers));
    facts.add(group + "empty_layers", fact_count(report.empty_layers));
    facts.add(group + "first_layer_contact_mm2", report.first_layer_contact_mm2);
    facts.add(group + "material_mm3", report.material_mm3);
    facts.add(group + "loose_parts", fact_count(report.loose_parts));
    facts.add(group + "closed_cavities", fact_count(report.closed_cavities));
    facts.add(group + "islands", fact_count(report.islands));
    facts.add(group + "overhang_area_mm2", report.overhang_area_mm2);
    add_place(group + "longest_bridge", report.longest_bridge, facts);
    add_place(group + "longest_cantilever", report.longest_cantilever, facts);
    facts.add(group + "thin_share", report.thin_share);
    if (report.least_solid) add_place(group + "least_solid", *report.least_solid, facts);
    facts.add(group + "narrow_share", report.narrow_share);
    if (report.least_hole) add_place(group + "least_hole", *report.least_hole, facts);
    facts.add(group + "faults", faults);
    facts.add(group + "island_layers", layers_with_islands(report));
    facts.add(group + "island_places", island_places(report));
}

}  // namespace fretwork
