#include "core/exemplar/builtin/builtin_patterns.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "support/make_pictures.h"

namespace fretwork {
namespace {

struct Pieces {
    int count = 0;
    double largest_share = 0;
};

/// Pieces of one phase on the torus, joined over pixel sides.
Pieces pieces_of(const Exemplar& e, std::uint8_t phase) {
    const int w = e.width, h = e.height;
    std::vector<std::uint8_t> seen(e.solid.size(), 0);
    std::size_t total = 0, largest = 0;
    Pieces pieces;
    std::vector<int> front;
    for (int start = 0; start < w * h; ++start) {
        if (e.solid[static_cast<std::size_t>(start)] != phase || seen[static_cast<std::size_t>(start)] != 0) continue;
        ++pieces.count;
        std::size_t size = 0;
        front.assign(1, start);
        seen[static_cast<std::size_t>(start)] = 1;
        while (!front.empty()) {
            const int i = front.back(), x = i % w, y = i / w;
            front.pop_back();
            ++size;
            for (const int n :
                 {y * w + (x + 1) % w, y * w + (x + w - 1) % w, (y + 1) % h * w + x, (y + h - 1) % h * w + x}) {
                const auto k = static_cast<std::size_t>(n);
                if (e.solid[k] != phase || seen[k] != 0) continue;
                seen[k] = 1;
                front.push_back(n);
            }
        }
        total += size;
        largest = std::max(largest, size);
    }
    pieces.largest_share = static_cast<double>(largest) / static_cast<double>(total);
    return pieces;
}

/// Share of a phase that no disc of radius `radius_px` inside the phase covers: ends of strokes narrower than its
/// diameter, and the tips of corners.
double thin_share(const Exemplar& e, bool solid, double radius_px) {
    const int w = e.width, h = e.height;
    std::vector<std::uint8_t> covered(e.solid.size(), 0);
    const auto depth = [&](std::size_t i) {
        return solid ? -static_cast<double>(e.feature_distance_px[i]) : static_cast<double>(e.feature_distance_px[i]);
    };
    std::size_t total = 0, left = 0;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const double r = depth(static_cast<std::size_t>(y * w + x));
            if (r < radius_px) continue;
            const int reach = static_cast<int>(r);
            for (int b = -reach; b <= reach; ++b)
                for (int a = -reach; a <= reach; ++a)
                    if (a * a + b * b <= r * r)
                        covered[static_cast<std::size_t>((y + b + h) % h * w + (x + a + w) % w)] = 1;
        }
    for (std::size_t i = 0; i < covered.size(); ++i)
        if (depth(i) > 0) {
            ++total;
            if (covered[i] == 0) ++left;
        }
    return static_cast<double>(left) / static_cast<double>(total);
}

struct Drawn {
    PatternPictures pictures;
    Exemplar exemplar;
};

/// Drawn once for all cases.
const Drawn& drawn(const std::string& name) {
    static std::map<std::string, Drawn> all;
    if (!all.contains(name)) {
        PatternPictures pictures = draw_builtin(name);
        Exemplar exemplar = make_exemplar(pictures.color, &pictures.mask,
                                          {.mask = MaskSource::kImage, .tileable = find_builtin(name).tileable});
        all.emplace(name, Drawn{std::move(pictures), std::move(exemplar)});
    }
    return all.at(name);
}

/// A row of the table in docs/patterns.md.
struct Documented {
    int width_px = 0, height_px = 0;
    double width_mm = 0, solid = 0;
    int pieces = 0;
    double stroke_px = 0;
    bool directed = false;
};

/// Reads "| `name` | 192 x 192 | 48 | 0.43 | 1 | 10 px, 2.5 mm | no | good for |".
std::map<std::string, Documented> documented_patterns() {
    std::map<std::string, Documented> rows;
    std::ifstream file(FRETWORK_REPOSITORY "/docs/patterns.md");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("| `")) continue;
        std::istringstream cells(line.substr(2));
        std::string name, cell;
        const auto next = [&]() -> std::string {
            std::getline(cells, cell, '|');
            return cell;
        };
        name = next();
        Documented row;
        char by = 0;
        std::istringstream(next()) >> row.width_px >> by >> row.height_px;
        row.width_mm = std::stod(next());
        row.solid = std::stod(next());
        row.pieces = std::stoi(next());
        row.stroke_px = std::stod(next());
        row.directed = next().find("yes") != std::string::npos;
        rows[name.substr(1, name.rfind('`') - 1)] = row;
    }
    return rows;
}

std::string any_pattern() {
    std::vector<std::string> names;
    for (const BuiltinPattern& p : builtin_patterns()) names.emplace_back(p.name);
    return GENERATE_COPY(from_range(names));
}

TEST_CASE("built-in patterns: hold what the list and the documentation say", "[exemplar][builtin]") {
    const std::string name = any_pattern();
    CAPTURE(name);
    const BuiltinPattern& pattern = find_builtin(name);
    const Exemplar& e = drawn(name).exemplar;

    CHECK(std::min(e.width, e.height) >= 128);
    CHECK(std::max(e.width, e.height) <= 256);
    CHECK(e.tileable == pattern.tileable);
    const std::map<std::string, Documented> table = documented_patterns();
    REQUIRE(table.contains(name));
    const Documented& row = table.at(name);
    CHECK(row.width_px == e.width);
    CHECK(row.height_px == e.height);
    CHECK(row.width_mm == pattern.width_mm);
    CHECK(row.directed == pattern.anisotropic);
    CHECK(e.solid_fraction() == Approx(row.solid).margin(0.0051));  // two digits in the table

    const Pieces solid = pieces_of(e, 1);
    CAPTURE(solid.count, solid.largest_share);
    CHECK(solid.count == row.pieces);
    CHECK((solid.count == 1) == pattern.connected);

    // No stroke and no gap is narrower than 6 px; what is left over are the tips of corners, of which drawn openings
    // have many.
    CHECK(thin_share(e, true, 3.0) < 0.01);
    CHECK(thin_share(e, false, 3.0) < 0.08);

    // The stroke radius that bridges take is a typical one: between half and twice the median over the ridge.
    std::vector<float> depth;
    for (const float f : e.feature_distance_px)
        if (f < 0) depth.push_back(-f);
    std::ranges::sort(depth);
    const double deep = depth[depth.size() * 95 / 100];
    CHECK(pattern.pattern_radius_px >= 0.5 * deep);
    CHECK(pattern.pattern_radius_px <= 2.0 * deep);
    CHECK(row.stroke_px == Approx(2 * pattern.pattern_radius_px).epsilon(0.3));
    // The narrowest stroke, 6 px, prints at the natural width: three lines of a 0.4 mm nozzle and more.
    CHECK(6.0 * pattern.width_mm / e.width >= 1.2);
}

TEST_CASE("built-in patterns: continue across their borders, and their crops do not", "[exemplar][builtin]") {
    const std::string name = any_pattern();
    CAPTURE(name);
    const PatternPictures& pictures = drawn(name).pictures;
    const ExemplarSettings detect{.mask = MaskSource::kImage};
    CHECK(make_exemplar(pictures.color, &pictures.mask, detect).tileable);

    const int width = pictures.color.width * 61 / 100, height = pictures.color.height * 57 / 100;
    const Image color = testing::crop(pictures.color, 3, 5, width, height);
    const Image mask = testing::crop(pictures.mask, 3, 5, width, height);
    CHECK_FALSE(make_exemplar(color, &mask, detect).tileable);
}

TEST_CASE("built-in patterns: dots are wholly disconnected, waves and zebra half solid", "[exemplar][builtin]") {
    const Pieces dots = pieces_of(drawn("dots").exemplar, 1);
    CHECK(dots.count >= 20);
    CHECK(dots.largest_share < 0.08);
    for (const char* name : {"waves", "zebra"}) {
        CAPTURE(name);
        const Exemplar& e = drawn(name).exemplar;
        CHECK(e.solid_fraction() == Approx(0.5).margin(0.02));
        CHECK(pieces_of(e, 1).largest_share < 0.6);
    }
}

TEST_CASE("built-in patterns: colours of the two phases differ", "[exemplar][builtin]") {
    // Synthesis compares colours: a pattern whose phases share a colour would have its mask matched by chance.
    const std::string name = any_pattern();
    CAPTURE(name);
    const Exemplar& e = drawn(name).exemplar;
    std::array<double, 3> sum[2] = {{0, 0, 0}, {0, 0, 0}};
    double count[2] = {0, 0};
    for (std::size_t i = 0; i < e.solid.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) sum[e.solid[i]][k] += e.color[i][k];
        ++count[e.solid[i]];
    }
    double apart = 0;
    for (std::size_t k = 0; k < 3; ++k) apart += std::pow(sum[0][k] / count[0] - sum[1][k] / count[1], 2);
    CHECK(std::sqrt(apart) > 60);
}

TEST_CASE("built-in patterns: what stands at a hole's wall looks like solid", "[exemplar][builtin]") {
    // Hole walls and bridges take the colour that solid has next to the border; it must not pass for the opening's.
    const std::string name = any_pattern();
    CAPTURE(name);
    const Exemplar& e = drawn(name).exemplar;
    std::array<double, 3> wall{}, inside{}, opening{};
    double walls = 0, insides = 0, openings = 0;
    const auto add = [&](std::array<double, 3>& sum, double& count, std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) sum[k] += e.color[i][k];
        ++count;
    };
    for (std::size_t i = 0; i < e.solid.size(); ++i) {
        const double depth = -static_cast<double>(e.feature_distance_px[i]);
        if (depth > 1.25 && depth < 2.25) add(wall, walls, i);
        if (depth > 2.25) add(inside, insides, i);
        if (depth < -1.25) add(opening, openings, i);
    }
    const auto apart = [&](const std::array<double, 3>& a, double na, const std::array<double, 3>& b, double nb) {
        return std::hypot(a[0] / na - b[0] / nb, a[1] / na - b[1] / nb, a[2] / na - b[2] / nb);
    };
    CHECK(apart(wall, walls, inside, insides) < 0.45 * apart(wall, walls, opening, openings));
}

TEST_CASE("built-in patterns: are drawn alike on every run and any number of threads", "[exemplar][determinism]") {
    for (const char* name : {"dots", "zebra"}) {
        CAPTURE(name);
        const auto with = [&](int threads) {
            const ThreadLimit limit(threads);
            return draw_builtin(name);
        };
        const PatternPictures one = with(1), three = with(3);
        CHECK(one.color.pixels == three.color.pixels);
        CHECK(one.mask.pixels == three.mask.pixels);
        const Exemplar made = make_builtin(name);
        CHECK(made.color == drawn(name).exemplar.color);
        CHECK(made.feature_distance_px == drawn(name).exemplar.feature_distance_px);
    }
}

TEST_CASE("built-in patterns: an unknown name is answered with the known ones", "[exemplar][builtin]") {
    CHECK(builtin_patterns().size() == documented_patterns().size());
    CHECK_THROWS_AS(find_builtin("cell"), InvalidSetting);
    CHECK_THROWS_AS(draw_builtin(""), InvalidSetting);
    CHECK_THROWS_WITH(make_builtin("nonsense"), Catch::Contains("nonsense") && Catch::Contains("hexagons"));
}

}  // namespace
}  // namespace fretwork
