#include "likeness/likeness_meter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/base/counter_random.h"
#include "likeness/shape_statistics.h"

namespace fretwork::likeness {
namespace {

constexpr int kCells = 4;
constexpr double kWorstShare = 0.05;

PatternPicture shifted(const PatternPicture& picture, double dx, double dy) {
    if (dx == 0.0 && dy == 0.0) return picture;
    // Without wrapping the last row and column have nothing to be mixed with.
    const int cut_x = !picture.wraps && dx > 0, cut_y = !picture.wraps && dy > 0;
    PatternPicture result = read_picture(picture, picture.width - cut_x, picture.height - cut_y,
                                         [&](int x, int y) { return Vec2(x + 0.5 + dx, y + 0.5 + dy); });
    result.wraps = picture.wraps;
    return result;
}

PatternPicture reduced(PatternPicture picture, int levels) {
    for (int l = 0; l < levels; ++l) picture = halved(picture);
    return picture;
}

/// Windows of a level of the exemplar at all half-pixel phases; corners as shares of the sides.
PlacedWindows phased_windows(const PatternPicture& exemplar, int level) {
    PlacedWindows all;
    const double half_pixel = 0.5 * (1 << level);
    for (int phase = 0; phase < 4; ++phase) {
        const double dx = (phase & 1) * half_pixel, dy = (phase >> 1) * half_pixel;
        const PatternPicture picture =
            level == 0 ? shifted(exemplar, dx, dy)
                       : reduced(halved(exemplar, static_cast<int>(dx), static_cast<int>(dy)), level - 1);
        const PlacedWindows placed = all_windows(picture);
        const Eigen::Index before = all.windows.rows();
        all.windows.conservativeResize(before + placed.windows.rows(), Eigen::NoChange);
        all.windows.bottomRows(placed.windows.rows()) = placed.windows;
        for (const Vec2f& c : placed.corner)
            all.corner.emplace_back(c.x() / static_cast<float>(picture.width - (picture.wraps ? 0 : kWindowSide - 1)),
                                    c.y() / static_cast<float>(picture.height - (picture.wraps ? 0 : kWindowSide - 1)));
    }
    return all;
}

double usual_distance(const Windows& windows, std::uint64_t seed) {
    constexpr std::size_t pairs = 3000;
    const auto pick = [&](std::size_t i, std::uint32_t draw) {
        return static_cast<Eigen::Index>(index_below(counter_random(seed, RandomStream::kTest, 1, i, draw),
                                                     static_cast<std::uint32_t>(windows.rows())));
    };
    double sum = 0.0;
    for (std::size_t i = 0; i < pairs; ++i)
        sum += static_cast<double>((windows.row(pick(i, 0)) - windows.row(pick(i, 1))).squaredNorm());
    return sum / pairs;
}

double mean_distance(const std::vector<Nearest>& found) {
    double sum = 0.0;
    for (const Nearest& n : found) sum += n.squared_distance;
    return sum / static_cast<double>(found.size());
}

double mean_of_worst(const std::vector<Nearest>& found) {
    std::vector<double> distances;
    distances.reserve(found.size());
    for (const Nearest& n : found) distances.push_back(n.squared_distance);
    std::ranges::sort(distances, std::greater<>());
    const auto worst =
        std::max<std::size_t>(1, static_cast<std::size_t>(kWorstShare * static_cast<double>(found.size())));
    double sum = 0.0;
    for (std::size_t i = 0; i < worst; ++i) sum += distances[i];
    return sum / static_cast<double>(worst);
}

double divergence_from_even(const std::vector<Nearest>& found, const std::vector<Vec2f>& corners) {
    std::array<double, kCells * kCells> used{};
    for (const Nearest& n : found) {
        const auto cell = [](float share) { return std::min(kCells - 1, static_cast<int>(share * kCells)); };
        const Vec2f& c = corners[n.row];
        used[static_cast<std::size_t>(cell(c.y()) * kCells + cell(c.x()))] += 1.0 / static_cast<double>(found.size());
    }
    constexpr double even = 1.0 / (kCells * kCells);
    const auto term = [](double p, double mean) { return p > 0 ? 0.5 * p * std::log2(p / mean) : 0.0; };
    double sum = 0.0;
    for (const double p : used) sum += term(p, 0.5 * (p + even)) + term(even, 0.5 * (p + even));
    return sum;
}

double chord_difference(const PatternPicture& output, const PatternPicture& exemplar) {
    double sum = 0.0;
    for (const bool solid : {false, true})
        for (int direction = 0; direction < 4; ++direction)
            sum += relative_wasserstein(chord_lengths(output, solid, direction),
                                        chord_lengths(exemplar, solid, direction));
    return sum / 8;
}

double thickness_difference(const PatternPicture& output, const PatternPicture& exemplar) {
    double sum = 0.0;
    for (const bool solid : {false, true})
        sum += relative_wasserstein(thicknesses(output, solid), thicknesses(exemplar, solid));
    return sum / 2;
}

}  // namespace

struct LikenessMeter::Level {
    explicit Level(PlacedWindows windows, const MeterSettings& settings)
        : reference(std::move(windows)),
          basis(principal_basis(reference.windows)),
          search(reference.windows, basis),
          wanted(some_windows(reference, settings.samples, settings.seed).windows),
          usual(usual_distance(reference.windows, settings.seed)) {}

    PlacedWindows reference;
    WindowBasis basis;
    NearestWindows search;
    Windows wanted;  ///< windows of the exemplar that an output should have
    double usual;    ///< z_l
};

LikenessMeter::LikenessMeter(PatternPicture exemplar, const MeterSettings& settings)
    : exemplar_(std::move(exemplar)), settings_(settings) {
    for (int l = 0; l < settings.levels; ++l)
        levels_.push_back(std::make_unique<Level>(phased_windows(exemplar_, l), settings));
}

LikenessMeter::~LikenessMeter() = default;

void LikenessMeter::measure_level(std::size_t l, const Windows& queries, const Windows& pool, Likeness& result) const {
    const Level& level = *levels_[l];
    const double share = 1.0 / static_cast<double>(levels_.size());
    const std::vector<Nearest> found = level.search.nearest(queries);
    result.coherence += share * mean_distance(found) / level.usual;
    const NearestWindows own(pool, level.basis);
    result.completeness += share * mean_distance(own.nearest(level.wanted)) / level.usual;
    if (l != 0) return;
    result.worst_seam = mean_of_worst(found) / level.usual;
    result.coverage = divergence_from_even(found, level.reference.corner);
}

Likeness LikenessMeter::measure(const PatternPicture& output) const {
    Likeness result;
    PatternPicture picture = output;
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        if (l > 0) picture = halved(picture);
        const PlacedWindows all = all_windows(picture);
        measure_level(l, some_windows(all, settings_.samples, settings_.seed + 1).windows, all.windows, result);
    }
    result.solid_difference = std::abs(output.solid_fraction() - exemplar_.solid_fraction());
    result.chords = chord_difference(output, exemplar_);
    result.thickness = thickness_difference(output, exemplar_);
    return result;
}

Likeness LikenessMeter::measure(const std::vector<Windows>& by_level) const {
    Likeness result;
    for (std::size_t l = 0; l < by_level.size(); ++l) measure_level(l, by_level[l], by_level[l], result);
    const double given = static_cast<double>(levels_.size()) / static_cast<double>(by_level.size());
    result.coherence *= given;
    result.completeness *= given;
    return result;
}

Likeness mean_of(const std::vector<Likeness>& values) {
    Likeness mean;
    const double share = 1.0 / static_cast<double>(values.size());
    for (const Likeness& v : values) {
        mean.completeness += share * v.completeness;
        mean.coherence += share * v.coherence;
        mean.worst_seam += share * v.worst_seam;
        mean.coverage += share * v.coverage;
        mean.solid_difference += share * v.solid_difference;
        mean.chords += share * v.chords;
        mean.thickness += share * v.thickness;
    }
    return mean;
}

}  // namespace fretwork::likeness
