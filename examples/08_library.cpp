// The engine as a library: a model and a pattern made in memory, a carved model written to a file.
//   08_library OUT.3mf [RESOLUTION]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>

#include "core/exemplar/exemplar.h"
#include "core/pipeline/carve.h"
#include "formats/mesh_file.h"

namespace {

using namespace fretwork;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// A ring around z; distances in millimetres.
TriangleMesh make_ring(double major_mm, double minor_mm) {
    constexpr std::uint32_t kAround = 96, kAcross = 48;
    TriangleMesh ring;
    for (std::uint32_t i = 0; i < kAround; ++i)
        for (std::uint32_t j = 0; j < kAcross; ++j) {
            const double a = kTurn * i / kAround, b = kTurn * j / kAcross, r = major_mm + minor_mm * std::cos(b);
            ring.positions_mm.emplace_back(r * std::cos(a), r * std::sin(a), minor_mm * (1 + std::sin(b)));
            const std::uint32_t next_i = (i + 1) % kAround * kAcross, next_j = (j + 1) % kAcross;
            ring.triangles.push_back({i * kAcross + j, next_i + j, next_i + next_j});
            ring.triangles.push_back({i * kAcross + j, next_i + next_j, i * kAcross + next_j});
        }
    return ring;
}

/// Dark tracery around light openings of two sizes; continues across its borders.
Exemplar make_tracery() {
    constexpr int kSide = 128;
    Image picture{kSide, kSide, {}, false};
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double u = 2 * kTurn * x / kSide, v = 2 * kTurn * y / kSide;
            const double height = std::cos(u) + std::cos(v) + 0.45 * std::cos(u) * std::cos(v);
            const double light = std::clamp(0.5 + 4.0 * (std::abs(height + 0.12) - 0.62), 0.0, 1.0);
            const auto mix = [&](int dark, int bright) {
                return static_cast<std::uint8_t>(std::lround(dark + light * (bright - dark)));
            };
            picture.pixels.push_back({mix(122, 250), mix(62, 244), mix(142, 235), 255});
        }
    return make_exemplar(picture);
}

void run(const char* target, int resolution) {
    CarveInput input;
    input.mesh = make_ring(34.0, 16.0);
    input.model_name = "ring";
    input.exemplar = make_tracery();
    input.exemplar_width_mm = 30.0;
    input.exemplar_name = "tracery";

    Settings settings;
    settings.shell.resolution = resolution;
    settings.synthesis.orientation.mode = Orientation::kFree;

    const CarveResult result = carve(input, settings);
    write_mesh(target, {result.carved.mesh, result.carved.triangle_colors, "ring"});
    std::printf("%s: %zu triangles, %.0f %% solid\n", target, result.carved.mesh.triangles.size(),
                100.0 * result.report.pattern.solid_fraction);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        std::fprintf(stderr, "usage: 08_library OUT.3mf [RESOLUTION]\n");
        return 1;
    }
    try {
        run(arguments[1], count > 2 ? std::atoi(arguments[2]) : 256);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "08_library: %s\n", error.what());
        return 2;
    }
}
