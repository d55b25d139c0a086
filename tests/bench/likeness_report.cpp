#include "likeness_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "markdown.h"

namespace fretwork::bench {
namespace {

using likeness::Likeness;

double patches(const Likeness& l) {
    return l.patches();
}
double worst_seam(const Likeness& l) {
    return l.worst_seam;
}

/// Differences of windows below this share of the distance of random ones cannot be seen.
constexpr double kInvisible = 0.005;

/// Whether ours lies between crop and good synthesis; differences within two standard errors are none.
std::string verdict(const Series& ours, const Series& good) {
    double worst = 0.0;
    bool above = false;
    for (const auto value : {patches, worst_seam}) {
        const double mine = value(ours.mean()), theirs = value(good.mean());
        const double noise = 2.0 * std::hypot(ours.error(value), good.error(value));
        above = above || mine > theirs + std::max(noise, kInvisible);
        worst = std::max(worst, mine / std::max(theirs, 1e-9));
    }
    return above ? fmt::format("no, {:.2f} x 2D synthesis", worst) : "yes";
}

std::string table_of(const std::vector<ExemplarResult>& results, double (*value)(const Likeness&),
                     const std::function<const Measured&(const ExemplarResult&)>& part) {
    const std::vector<std::string> columns = part(results.front()).columns();
    std::vector<std::string> heads{"exemplar"};
    heads.insert(heads.end(), columns.begin(), columns.end());
    MarkdownTable table(heads);
    std::vector<double> sums(columns.size(), 0.0);
    for (const ExemplarResult& r : results) {
        std::vector<std::string> cells{r.name};
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const double v = value(part(r).at(columns[c]).mean());
            sums[c] += v / static_cast<double>(results.size());
            cells.push_back(fmt::format("{:.3f}", v));
        }
        table.add(cells);
    }
    std::vector<std::string> means{"**mean**"};
    for (const double s : sums) means.push_back(fmt::format("**{:.3f}**", s));
    table.add(means);
    return table.text();
}

std::string verdict_table(const LikenessReportSettings& options, const std::vector<ExemplarResult>& results) {
    std::vector<std::string> heads{"exemplar"};
    for (const std::string& v : options.variants) heads.push_back("plate, " + v);
    for (const std::string& m : options.models) heads.push_back(m + ", default");
    MarkdownTable table(heads);
    for (const ExemplarResult& r : results) {
        std::vector<std::string> cells{r.name};
        for (const std::string& v : options.variants) cells.push_back(verdict(r.flat.at(v), r.flat.at("2D synthesis")));
        for (const std::string& m : options.models)
            cells.push_back(verdict(r.curved.at(m).at("default"), r.curved.at("flat").at("2D synthesis")));
        table.add(cells);
    }
    return table.text();
}

std::string shape_table(const LikenessReportSettings& options, const std::vector<ExemplarResult>& results) {
    std::vector<std::string> heads{"exemplar", "solid of exemplar", "solid, plate"};
    for (const std::string& m : options.models) heads.push_back("solid, " + m);
    if (options.structure) heads.emplace_back("solid, plate, reinforced");
    heads.insert(heads.end(), {"within 5 points", "chords: 2D synthesis / ours", "thickness: 2D synthesis / ours",
                               "coverage: crop / 2D synthesis / ours"});
    MarkdownTable table(heads);
    for (const ExemplarResult& r : results) {
        const Series &ours = r.flat.at("default"), &good = r.flat.at("2D synthesis");
        std::vector<double> fractions = ours.solid_fraction;
        std::vector<std::string> cells{r.name, fmt::format("{:.3f}", r.solid_fraction),
                                       fmt::format("{:.3f}", ours.mean_solid_fraction())};
        for (const std::string& m : options.models) {
            const Series& s = r.curved.at(m).at("default");
            cells.push_back(fmt::format("{:.3f}", s.mean_solid_fraction()));
            fractions.insert(fractions.end(), s.solid_fraction.begin(), s.solid_fraction.end());
        }
        if (options.structure)
            cells.push_back(fmt::format("{:.3f}", r.flat.at("default, resynthesised").mean_solid_fraction()));
        double worst = 0.0;
        for (const double f : fractions) worst = std::max(worst, std::abs(f - r.solid_fraction));
        cells.push_back(fmt::format("{} ({:.1f})", worst <= 0.05 ? "yes" : "no", 100 * worst));
        const Likeness a = r.flat.at("crop").mean(), b = good.mean(), c = ours.mean();
        cells.push_back(fmt::format("{:.3f} / {:.3f}", b.chords, c.chords));
        cells.push_back(fmt::format("{:.3f} / {:.3f}", b.thickness, c.thickness));
        cells.push_back(fmt::format("{:.2f} / {:.2f} / {:.2f}", a.coverage, b.coverage, c.coverage));
        table.add(cells);
    }
    return table.text();
}

/// Baselines and our own on one model, side by side.
Measured beside_baselines(const ExemplarResult& r, const std::string& model) {
    Measured all = r.curved.at("flat");
    for (const std::string& column : r.curved.at(model).columns()) all[column] = r.curved.at(model).at(column);
    return all;
}

}  // namespace

double Series::error(double (*value)(const Likeness&)) const {
    const double center = value(mean());
    double sum = 0.0;
    for (const Likeness& l : by_seed) sum += (value(l) - center) * (value(l) - center);
    const auto n = static_cast<double>(by_seed.size());
    return n < 2 ? 0.0 : std::sqrt(sum / (n - 1) / n);
}

double Series::mean_solid_fraction() const {
    double sum = 0.0;
    for (const double s : solid_fraction) sum += s;
    return sum / static_cast<double>(std::max<std::size_t>(1, solid_fraction.size()));
}

Series& Measured::operator[](const std::string& column) {
    const auto found = std::ranges::find(columns_, column, &std::pair<std::string, Series>::first);
    return found != columns_.end() ? found->second : columns_.emplace_back(column, Series{}).second;
}

const Series& Measured::at(const std::string& column) const {
    return std::ranges::find(columns_, column, &std::pair<std::string, Series>::first)->second;
}

std::vector<std::string> Measured::columns() const {
    std::vector<std::string> names;
    for (const auto& [name, series] : columns_) names.push_back(name);
    return names;
}

std::string likeness_report(const LikenessReportSettings& options, const std::vector<ExemplarResult>& results) {
    const auto flat = [](const ExemplarResult& r) -> const Measured& { return r.flat; };
    std::string text = fmt::format(
        "Means over {} seeds; plates of {} x {} voxels; 0 = as alike as can be. *Resynthesised*: after the loop of "
        "Algorithm 1; *painted*: its bridges laid over the first synthesis instead. Plates are reinforced under "
        "gravity, the {} with the default loads.\n\n",
        options.seeds, options.plate, options.plate, options.models.empty() ? "curved models" : options.models.front());
    text +=
        "**Between crop and good 2D synthesis?** Patch similarity and worst seam both; differences within two "
        "standard errors, or below 0.005, count as none.\n\n" +
        verdict_table(options, results);
    text += "\n**Bidirectional patch similarity, plate**\n\n" + table_of(results, patches, flat);
    text += "\n**Worst seams, plate**\n\n" + table_of(results, worst_seam, flat);
    text +=
        "\n**Shapes, default preset.** In brackets: the largest difference of any run before reinforcement, in "
        "points.\n\n" +
        shape_table(options, results);
    for (const std::string& model : options.models) {
        std::vector<Measured> kept;
        kept.reserve(results.size());
        for (const ExemplarResult& r : results) kept.push_back(beside_baselines(r, model));
        const auto on_model = [&](const ExemplarResult& r) -> const Measured& {
            return kept[static_cast<std::size_t>(&r - results.data())];
        };
        text += fmt::format(
                    "\n**Patch similarity, {} at {} voxels** ({} tangent windows; baselines measured the same "
                    "way on flat ones)\n\n",
                    model, options.curved, options.curved_windows) +
                table_of(results, patches, on_model);
        text += fmt::format("\n**Worst seams, {}**\n\n", model) + table_of(results, worst_seam, on_model);
    }
    return text;
}

}  // namespace fretwork::bench
