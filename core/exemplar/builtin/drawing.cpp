#include "core/exemplar/builtin/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>

#include "core/base/counter_random.h"
#include "core/base/parallel.h"
#include "core/exemplar/color_space.h"

namespace fretwork::drawing {
namespace {

struct Pixel {
    Ink color;
    float cover;
};

Rgba8 encode(const Ink& c) {
    return {to_byte(linear_to_srgb(c.r)), to_byte(linear_to_srgb(c.g)), to_byte(linear_to_srgb(c.b)), 255};
}

bool is_close(const Ink& a, const Ink& b) {
    constexpr float kStep = 0.04f;
    return std::abs(a.r - b.r) < kStep && std::abs(a.g - b.g) < kStep && std::abs(a.b - b.b) < kStep;
}

Pixel sample_pixel(double x, double y, const std::function<Sample(const Vec2&)>& look) {
    constexpr int kPerAxis = 3;
    constexpr float kShare = 1.0f / (kPerAxis * kPerAxis);
    Pixel sum{{0, 0, 0}, 0};
    for (int s = 0; s < kPerAxis * kPerAxis; ++s) {
        const int column = s % kPerAxis, row = s / kPerAxis;
        const Sample one = look({x + (column + 0.5) / kPerAxis, y + (row + 0.5) / kPerAxis});
        sum.color = {sum.color.r + kShare * one.color.r, sum.color.g + kShare * one.color.g,
                     sum.color.b + kShare * one.color.b};
        // A sample stands for a square of 1 / kPerAxis px that the border may cut.
        sum.cover += kShare * static_cast<float>(std::clamp(0.5 - one.distance * kPerAxis, 0.0, 1.0));
    }
    return sum;
}

}  // namespace

Ink ink(std::uint32_t rgb) {
    const auto channel = [&](unsigned shift) {
        return srgb_to_linear(static_cast<float>((rgb >> shift) & 0xffu) / 255.0f);
    };
    return {channel(16), channel(8), channel(0)};
}

Ink mix(const Ink& a, const Ink& b, double t) {
    const double u = std::clamp(t, 0.0, 1.0);
    const auto s = static_cast<float>(u * u * (3.0 - 2.0 * u));
    return {a.r + (b.r - a.r) * s, a.g + (b.g - a.g) * s, a.b + (b.b - a.b) * s};
}

Sample shade(double distance, const Relief& relief) {
    if (distance < 0) return {distance, mix(relief.solid_rim, relief.solid_core, -distance / relief.solid_depth)};
    return {distance, mix(relief.hole_rim, relief.hole_core, distance / relief.hole_depth)};
}

Vec2 Torus::shortest(Vec2 way) const {
    // Points lie within a picture or two of each other: a step or two beats a division.
    const auto fold = [](double x, double period) {
        while (x >= period / 2) x -= period;
        while (x < -period / 2) x += period;
        return x;
    };
    return {fold(way.x(), width), fold(way.y(), height)};
}

PatternPictures draw(int width_px, int height_px, const std::function<Sample(const Vec2&)>& look) {
    const auto width = static_cast<std::size_t>(width_px), height = static_cast<std::size_t>(height_px);
    std::vector<Sample> middle(width * height);
    parallel_for(height, 4, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x)
            middle[y * width + x] = look({static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
    });

    PatternPictures out;
    out.color = {width_px, height_px, {}, false};
    out.color.pixels.resize(middle.size());
    out.mask = out.color;
    parallel_for(height, 4, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t i = y * width + x;
            const std::array<const Sample*, 4> around = {
                &middle[y * width + (x + 1) % width], &middle[y * width + (x + width - 1) % width],
                &middle[(y + 1) % height * width + x], &middle[(y + height - 1) % height * width + x]};
            const bool plain = std::abs(middle[i].distance) > 2.0 && std::ranges::all_of(around, [&](const Sample* s) {
                                   return is_close(s->color, middle[i].color);
                               });
            const Pixel pixel = plain ? Pixel{middle[i].color, middle[i].distance < 0 ? 1.0f : 0.0f}
                                      : sample_pixel(static_cast<double>(x), static_cast<double>(y), look);
            out.color.pixels[i] = encode(pixel.color);
            const std::uint8_t grey = to_byte(pixel.cover);
            out.mask.pixels[i] = {grey, grey, grey, 255};
        }
    });
    return out;
}

double smooth_min(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * k * 0.25;
}

double smooth_min(const std::vector<double>& values, double k) {
    const double least = *std::ranges::min_element(values);
    double sum = 0;
    for (const double v : values)
        if (v - least < 8 * k) sum += std::exp((least - v) / k);
    return least - k * std::log(sum);
}

double rounded_box(const Vec2& p, const Vec2& half_size, double corner_radius) {
    const Vec2 q = p.cwiseAbs() - half_size + Vec2::Constant(corner_radius);
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - corner_radius;
}

double regular_polygon(const Vec2& p, int sides, double inner_radius, double corner_radius, double turn_rad) {
    // Into the sector of one side, whose normal then is +x.
    const double sector = 2 * std::numbers::pi / sides;
    const double angle = std::atan2(p.y(), p.x()) - turn_rad - std::numbers::pi / 2 + sector / 2;
    const double within = angle - sector * std::floor(angle / sector + 0.5);
    const double r = p.norm();
    const Vec2 q(r * std::cos(within), std::abs(r * std::sin(within)));
    const double inner = inner_radius - corner_radius;
    const double half_side = inner * std::tan(sector / 2);
    const double beyond = std::max(q.y() - half_side, 0.0);
    const double ahead = q.x() - inner;
    return (ahead > 0 ? std::hypot(ahead, beyond) : ahead) - corner_radius;
}

namespace {

/// A disc around points, as wide as the stroke is there.
struct Disc {
    Vec2 center = Vec2::Zero();
    double reach = 0.0;
};

Disc disc_around(std::span<const Vec2> points, std::span<const double> radius) {
    Vec2 low = points.front(), high = points.front();
    for (const Vec2& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    Disc disc{(low + high) / 2, 0.0};
    for (std::size_t i = 0; i < points.size(); ++i)
        disc.reach = std::max(disc.reach, (points[i] - disc.center).norm() + radius[i]);
    return disc;
}

}  // namespace

Stroke::Stroke(std::vector<Vec2> points, std::vector<double> radius)
    : points_(std::move(points)), radius_(std::move(radius)), center_(Vec2::Zero()) {
    const Disc whole = disc_around(points_, radius_);
    center_ = whole.center;
    reach_ = whole.reach;
    widest_ = *std::ranges::max_element(radius_);
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) lengths_.push_back((points_[i + 1] - points_[i]).norm());
    for (std::size_t first = 0; first + 1 < points_.size(); first += kRunSegments) {
        const std::size_t count = std::min(kRunSegments + 1, points_.size() - first);
        const Disc disc =
            disc_around(std::span(points_).subspan(first, count), std::span(radius_).subspan(first, count));
        runs_.push_back({disc.center - center_, disc.reach, first, first + count - 1});
    }
}

double Stroke::distance(const Vec2& p, const Torus& torus, double most) const {
    const Vec2 q = torus.shortest(p - center_);
    const double away = q.norm() - reach_;
    if (away > kNear || away >= most) return std::min(away, most);
    // A hair, so that rounding never rules out what holds the nearest point.
    constexpr double kHair = 1e-9;
    const auto is_beyond = [&](const Vec2& center, double reach, double best) {
        const double spare = best + reach + kHair;
        return spare < 0 || (q - center).squaredNorm() > spare * spare;
    };
    // Whatever comes first shows that most of the rest is farther away.
    const auto near_first =
        std::ranges::min_element(runs_, {}, [&](const Run& run) { return (q - run.center).squaredNorm(); });
    double best = most;
    const auto look_at = [&](const Run& run) {
        if (is_beyond(run.center, run.reach, best)) return;
        for (std::size_t i = run.first; i < run.last; ++i) {
            const Vec2 a = points_[i] - center_, ab = points_[i + 1] - points_[i];
            if (is_beyond(a, lengths_[i] + widest_, best)) continue;
            const double t = std::clamp((q - a).dot(ab) / std::max(ab.squaredNorm(), 1e-12), 0.0, 1.0);
            best = std::min(best, (q - a - t * ab).norm() - (radius_[i] + t * (radius_[i + 1] - radius_[i])));
        }
    };
    look_at(*near_first);
    for (const Run& run : runs_)
        if (&run != &*near_first) look_at(run);
    return best;
}

double joined(double distance, const Stroke& stroke, const Vec2& p, const Torus& torus, double k) {
    // What is farther by more than k has no say.
    constexpr double kHair = 1e-9;
    return smooth_min(distance, stroke.distance(p, torus, distance + k + kHair), k);
}

std::vector<Vec2> spline(const std::vector<Vec2>& knots, int steps, bool closed) {
    const int n = static_cast<int>(knots.size());
    const auto knot = [&](int i) -> const Vec2& {
        return knots[static_cast<std::size_t>(closed ? (i % n + n) % n : std::clamp(i, 0, n - 1))];
    };
    std::vector<Vec2> points;
    const int spans = closed ? n : n - 1;
    for (int s = 0; s < spans; ++s)
        for (int k = 0; k < steps; ++k) {
            const double t = static_cast<double>(k) / steps, t2 = t * t, t3 = t2 * t;
            points.push_back(0.5 * (2 * knot(s) + (knot(s + 1) - knot(s - 1)) * t +
                                    (2 * knot(s - 1) - 5 * knot(s) + 4 * knot(s + 1) - knot(s + 2)) * t2 +
                                    (3 * knot(s) - knot(s - 1) - 3 * knot(s + 1) + knot(s + 2)) * t3));
        }
    points.push_back(knot(spans));
    return points;
}

double random_unit(std::uint64_t seed, std::uint64_t item, std::uint32_t draw) {
    return unit_interval(counter_random(seed, RandomStream::kPattern, 0, item, draw));
}

std::vector<Vec2> scatter(const Torus& torus, std::size_t count, int relaxations, std::uint64_t seed) {
    std::vector<Vec2> points;
    const auto clearance = [&](const Vec2& p) {
        double best = std::numeric_limits<double>::infinity();
        for (const Vec2& q : points) best = std::min(best, torus.shortest(p - q).squaredNorm());
        return best;
    };
    constexpr std::uint32_t kCandidates = 16;
    while (points.size() < count) {
        Vec2 chosen = Vec2::Zero();
        double best = -1;
        for (std::uint32_t c = 0; c < kCandidates; ++c) {
            const Vec2 p(torus.width * random_unit(seed, points.size(), 2 * c),
                         torus.height * random_unit(seed, points.size(), 2 * c + 1));
            if (const double d = clearance(p); d > best) {
                best = d;
                chosen = p;
            }
        }
        points.push_back(chosen);
    }
    constexpr double kStep = 2.0;
    for (int r = 0; r < relaxations; ++r) {
        std::vector<Vec2> sum(count, Vec2::Zero());
        std::vector<double> cells(count, 0.0);
        for (double y = kStep / 2; y < torus.height; y += kStep)
            for (double x = kStep / 2; x < torus.width; x += kStep) {
                std::size_t nearest = 0;
                Vec2 way = Vec2::Constant(1e9);
                for (std::size_t i = 0; i < count; ++i)
                    if (const Vec2 w = torus.shortest(Vec2(x, y) - points[i]); w.squaredNorm() < way.squaredNorm()) {
                        way = w;
                        nearest = i;
                    }
                sum[nearest] += way;
                cells[nearest] += 1;
            }
        for (std::size_t i = 0; i < count; ++i)
            if (cells[i] > 0) points[i] += sum[i] / cells[i];
    }
    return points;
}

}  // namespace fretwork::drawing
