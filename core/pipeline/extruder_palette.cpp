#include "core/pipeline/extruder_palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/exemplar/lab.h"

namespace fretwork {
namespace {

constexpr int kMostTurns = 100;

/// Colours that differ by less than the step of a channel in 5 bits count as one.
struct Swatch {
    Lab color = Lab::Zero();
    double weight = 0.0;
};

std::vector<Swatch> swatches_of(std::span<const Rgb8> colors, std::span<const double> weights) {
    std::map<Rgb8, std::pair<std::array<double, 3>, double>> bins;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        Rgb8 bin{};
        for (std::size_t k = 0; k < 3; ++k) bin[k] = static_cast<std::uint8_t>(colors[i][k] >> 3);
        auto& [sum, weight] = bins[bin];
        for (std::size_t k = 0; k < 3; ++k) sum[k] += weights[i] * colors[i][k];
        weight += weights[i];
    }
    std::vector<Swatch> swatches;
    for (const auto& [bin, entry] : bins) {
        const auto& [sum, weight] = entry;
        if (weight <= 0.0) continue;
        Rgb8 mean{};
        for (std::size_t k = 0; k < 3; ++k) mean[k] = static_cast<std::uint8_t>(std::lround(sum[k] / weight));
        swatches.push_back({srgb_to_lab(mean), weight});
    }
    return swatches;
}

std::size_t nearest(const std::vector<Lab>& centers, const Lab& color) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < centers.size(); ++c)
        if (const double distance = (centers[c] - color).squaredNorm(); distance < least) {
            least = distance;
            best = c;
        }
    return best;
}

/// The most used colour, then always the one that is worst served so far.
std::vector<Lab> first_centers(const std::vector<Swatch>& swatches, std::size_t count) {
    const auto heaviest = std::ranges::max_element(swatches, {}, &Swatch::weight);
    std::vector<Lab> centers = {heaviest->color};
    while (centers.size() < count) {
        const auto cost = [&](const Swatch& s) {
            return s.weight * (centers[nearest(centers, s.color)] - s.color).squaredNorm();
        };
        const auto worst = std::ranges::max_element(swatches, {}, cost);
        if (cost(*worst) <= 0.0) break;
        centers.push_back(worst->color);
    }
    return centers;
}

/// Moves every centre to the middle of what it serves until that does not change.
std::vector<std::size_t> settle(const std::vector<Swatch>& swatches, std::vector<Lab>& centers) {
    std::vector<std::size_t> owner(swatches.size(), centers.size());
    for (int turn = 0; turn < kMostTurns; ++turn) {
        std::vector<Lab> sum(centers.size(), Lab::Zero());
        std::vector<double> weight(centers.size(), 0.0);
        bool changed = false;
        for (std::size_t s = 0; s < swatches.size(); ++s) {
            const std::size_t c = nearest(centers, swatches[s].color);
            changed = changed || c != owner[s];
            owner[s] = c;
            sum[c] += swatches[s].weight * swatches[s].color;
            weight[c] += swatches[s].weight;
        }
        if (!changed) break;
        for (std::size_t c = 0; c < centers.size(); ++c)
            if (weight[c] > 0.0) centers[c] = sum[c] / weight[c];
    }
    return owner;
}

}  // namespace

std::vector<Rgb8> extruder_palette(std::span<const Rgb8> colors, std::span<const double> weights, int extruders) {
    if (colors.empty() || colors.size() != weights.size())
        throw InvalidInput("palette: found " + std::to_string(colors.size()) + " colours and " +
                           std::to_string(weights.size()) + " weights, expected as many of both");
    const std::vector<Swatch> swatches = swatches_of(colors, weights);
    if (swatches.empty()) throw InvalidInput("palette: found no colour of any weight, expected one");
    std::vector<Lab> centers = first_centers(swatches, static_cast<std::size_t>(std::clamp(extruders, 1, 16)));
    const std::vector<std::size_t> owner = settle(swatches, centers);

    struct Entry {
        double weight = 0.0;
        Rgb8 color{};
    };
    std::vector<Entry> entries(centers.size());
    for (std::size_t s = 0; s < swatches.size(); ++s) entries[owner[s]].weight += swatches[s].weight;
    for (std::size_t c = 0; c < centers.size(); ++c) entries[c].color = lab_to_srgb(centers[c]);
    std::ranges::stable_sort(entries, std::greater{}, &Entry::weight);
    std::vector<Rgb8> palette;
    for (const Entry& entry : entries)
        if (entry.weight > 0.0 && std::ranges::find(palette, entry.color) == palette.end())
            palette.push_back(entry.color);
    return palette;
}

std::vector<std::uint8_t> extruders_of(std::span<const Rgb8> colors, std::span<const Rgb8> palette) {
    std::vector<Lab> centers;
    for (const Rgb8& color : palette) centers.push_back(srgb_to_lab(color));
    std::vector<std::uint8_t> extruders(colors.size());
    parallel_for(colors.size(), 4096, [&](std::size_t i) {
        extruders[i] = static_cast<std::uint8_t>(nearest(centers, srgb_to_lab(colors[i])) + 1);
    });
    return extruders;
}

}  // namespace fretwork
