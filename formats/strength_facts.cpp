#include "formats/strength_facts.h"

namespace fretwork {
namespace {

void add_stress(const std::string& group, const StressStatistics& stress, Facts& facts) {
    facts.add(group + "average_pa", stress.average_pa);
    facts.add(group + "median_pa", stress.median_pa);
    facts.add(group + "p99_pa", stress.p99_pa);
    facts.add(group + "max_pa", stress.max_pa);
}

std::vector<Facts> case_facts(const StrengthReport& report) {
    std::vector<Facts> cases;
    for (const StrengthCase& load_case : report.cases) {
        Facts& facts = cases.emplace_back();
        facts.add("name", load_case.name);
        facts.add("factor_of_safety", load_case.least_factor);
        add_stress("stress_sum.", load_case.stress_sum, facts);
        facts.add("max_von_mises_pa", load_case.max_von_mises_pa);
        facts.add("max_displacement_mm", load_case.max_displacement_mm);
        facts.add("applied_n", fact_point(load_case.applied_n));
        facts.add("reaction_n", fact_point(load_case.reaction_n));
        facts.add("iterations", std::int64_t{load_case.iterations});
    }
    return cases;
}

std::vector<Facts> weak_places(const StrengthReport& report) {
    std::vector<Facts> places;
    for (const WeakPlace& place : report.weakest)
        places.push_back({{{"at_mm", fact_point(place.at_mm)},
                           {"factor_of_safety", place.factor},
                           {"stress_sum_pa", place.stress_sum_pa},
                           {"von_mises_pa", place.von_mises_pa},
                           {"case", report.cases[place.load_case].name}}});
    return places;
}

}  // namespace

void add_strength_facts(const StrengthCheck& check, const std::vector<std::string>& faults, const std::string& group,
                        Facts& facts) {
    const StrengthReport& report = check.report;
    facts.add(group + "holds", report.holds());
    facts.add(group + "factor_of_safety", report.least_factor);
    facts.add(group + "safety_factor", report.safety_factor);
    add_stress(group + "stress_sum.", report.stress_sum, facts);
    facts.add(group + "voxel_mm", report.voxel_mm);
    facts.add(group + "coarser_than_asked", check.coarser);
    facts.add(group + "voxels", fact_count(report.voxels));
    facts.add(group + "nodes", fact_count(report.nodes));
    facts.add(group + "pieces", fact_count(report.pieces));
    facts.add(group + "joining_voxels", fact_count(report.joining_voxels));
    facts.add(group + "volume_mm3", report.volume_mm3);
    facts.add(group + "weight_n", report.weight_n);
    facts.add(group + "solver", std::string(report.by_factor ? "factor" : "multigrid"));
    facts.add(group + "faults", faults);
    facts.add(group + "cases", case_facts(report));
    facts.add(group + "weakest", weak_places(report));
}

}  // namespace fretwork
