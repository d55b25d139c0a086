// How alike a flat synthesised pattern and its exemplar are, by windows of colour and mask.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "core/exemplar/exemplar.h"

namespace fretwork::testing {

/// A picture of what a pattern shows: colour and mask, in [0, 1].
struct Likened {
    int width = 0, height = 0;
    std::vector<std::array<float, 4>> pixels;
};

inline Likened likened(int width, int height, const std::vector<Rgb8>& color, const std::vector<std::uint8_t>& solid) {
    Likened picture{width, height, {}};
    for (std::size_t i = 0; i < color.size(); ++i)
        picture.pixels.push_back({static_cast<float>(color[i][0]) / 255.0F, static_cast<float>(color[i][1]) / 255.0F,
                                  static_cast<float>(color[i][2]) / 255.0F, solid[i] != 0 ? 1.0F : 0.0F});
    return picture;
}

struct Likeness {
    /// Mean of the worst 5 % of the distances from windows of the output to the nearest one of the
    /// exemplar, over the mean distance of random windows: cut features and seams. 0 = verbatim.
    double worst_seam = 0;
    /// Jensen-Shannon divergence, in bits, between uniform use of the exemplar and where the nearest
    /// windows lie, over a 4 x 4 grid: missing content and collapse. 0 = all used alike, 1 = the limit.
    double coverage = 0;
};

/// Windows of 7 x 7 pixels, `samples` of them drawn from the output with a fixed seed.
class LikenessMeter {
  public:
    explicit LikenessMeter(Likened exemplar) : e_(std::move(exemplar)), columns_(e_.width - kSide + 1) {
        std::mt19937 rng{1};
        for (int i = 0; i < 2000; ++i) {
            const int count = columns_ * (e_.height - kSide + 1);
            const int a = static_cast<int>(rng() % static_cast<unsigned>(count));
            const int b = static_cast<int>(rng() % static_cast<unsigned>(count));
            usual_ += distance(e_, a % columns_, a / columns_, b % columns_, b / columns_, kNone) / 2000;
        }
    }

    [[nodiscard]] Likeness measure(const Likened& output, int samples) const {
        std::mt19937 rng{2};
        std::vector<double> nearest;
        std::array<double, kCells * kCells> used{};
        for (int i = 0; i < samples; ++i) {
            const int x = static_cast<int>(rng() % static_cast<unsigned>(output.width - kSide + 1));
            const int y = static_cast<int>(rng() % static_cast<unsigned>(output.height - kSide + 1));
            float best = kNone;
            std::size_t cell = 0;
            for (int ey = 0; ey + kSide <= e_.height; ++ey)
                for (int ex = 0; ex < columns_; ++ex)
                    if (const float d = distance(output, x, y, ex, ey, best); d < best) {
                        best = d;
                        cell = static_cast<std::size_t>(ey * kCells / (e_.height - kSide + 1) * kCells +
                                                        ex * kCells / columns_);
                    }
            nearest.push_back(static_cast<double>(best) / usual_);
            used[cell] += 1.0 / samples;
        }
        std::sort(nearest.begin(), nearest.end(), std::greater<>());
        Likeness result;
        const auto worst = static_cast<std::size_t>(std::max(1, samples / 20));
        for (std::size_t i = 0; i < worst; ++i) result.worst_seam += nearest[i] / static_cast<double>(worst);
        const auto term = [](double p, double mean) { return p > 0 ? 0.5 * p * std::log2(p / mean) : 0.0; };
        constexpr double even = 1.0 / (kCells * kCells);
        for (const double p : used) result.coverage += term(p, 0.5 * (p + even)) + term(even, 0.5 * (p + even));
        return result;
    }

  private:
    static constexpr int kSide = 7, kCells = 4;
    static constexpr float kNone = std::numeric_limits<float>::max();

    /// Between the window at (x, y) of `a` and the one at (ex, ey) of the exemplar; gives up above `limit`.
    [[nodiscard]] float distance(const Likened& a, int x, int y, int ex, int ey, float limit) const {
        float sum = 0;
        for (int j = 0; j < kSide && sum < limit; ++j)
            for (int i = 0; i < kSide; ++i) {
                const auto& p = a.pixels[static_cast<std::size_t>((y + j) * a.width + x + i)];
                const auto& q = e_.pixels[static_cast<std::size_t>((ey + j) * e_.width + ex + i)];
                for (std::size_t c = 0; c < 4; ++c) sum += (p[c] - q[c]) * (p[c] - q[c]);
            }
        return sum;
    }

    Likened e_;
    int columns_;
    double usual_ = 0;
};

}  // namespace fretwork::testing
