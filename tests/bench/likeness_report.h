// What the likeness benchmark has measured, and its tables.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "likeness/likeness_meter.h"

namespace fretwork::bench {

/// One exemplar, one way of showing it, some seeds.
struct Series {
    std::vector<likeness::Likeness> by_seed;
    std::vector<double> solid_fraction;

    [[nodiscard]] likeness::Likeness mean() const { return likeness::mean_of(by_seed); }
    /// Standard error over the seeds.
    [[nodiscard]] double error(double (*value)(const likeness::Likeness&)) const;
    [[nodiscard]] double mean_solid_fraction() const;
};

/// Columns by name, in order of their first use.
class Measured {
  public:
    Series& operator[](const std::string& column);
    [[nodiscard]] const Series& at(const std::string& column) const;
    [[nodiscard]] std::vector<std::string> columns() const;

  private:
    std::vector<std::pair<std::string, Series>> columns_;
};

struct ExemplarResult {
    std::string name;
    double solid_fraction = 0.0;
    Measured flat;
    std::map<std::string, Measured> curved;  ///< by model
};

/// How the run was asked for, as far as the tables tell of it.
struct LikenessReportSettings {
    int seeds = 3, plate = 160, curved = 144;
    std::size_t curved_windows = 1000;
    bool structure = true;
    std::vector<std::string> variants;  ///< "default" first
    std::vector<std::string> models;    ///< curved ones; the first is the one that is reinforced
};

/// The whole section, in Markdown.
std::string likeness_report(const LikenessReportSettings& settings, const std::vector<ExemplarResult>& results);

}  // namespace fretwork::bench
