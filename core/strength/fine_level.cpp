#include "core/strength/fine_level.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/base/avx2.h"
#include "core/base/counter_random.h"

namespace fretwork {
namespace {

constexpr std::size_t kLanes = 16;  // voxels that go through the arithmetic side by side
constexpr std::size_t kGrain = 8192;
constexpr std::uint32_t kLeastVoxels = 2048;

/// Sums and differences over the three axes, in place: the Hadamard transform, which is its own inverse but for 1 / 8.
template <class T>
[[gnu::always_inline]] inline void hadamard(T (&v)[8][kLanes]) {
    for (std::size_t step = 1; step < 8; step *= 2)
        for (std::size_t i = 0; i < 8; ++i) {
            if ((i & step) != 0) continue;
            for (std::size_t l = 0; l < kLanes; ++l) {
                const T a = v[i][l], b = v[i + step][l];
                v[i][l] = a + b;
                v[i + step][l] = a - b;
            }
        }
}

/// v <- K v for kLanes voxels at once; [axis][corner bits][voxel].
template <class T>
[[gnu::always_inline]] inline void multiply(const T* blocks, T (&v)[3][8][kLanes]) {
    for (std::size_t axis = 0; axis < 3; ++axis) hadamard(v[axis]);
    for (std::size_t p = 0; p < 8; ++p) {
        const T* b = blocks + 9 * p;
        for (std::size_t l = 0; l < kLanes; ++l) {
            const T x = v[0][p ^ 1][l], y = v[1][p ^ 2][l], z = v[2][p ^ 4][l];
            v[0][p ^ 1][l] = b[0] * x + b[1] * y + b[2] * z;
            v[1][p ^ 2][l] = b[3] * x + b[4] * y + b[5] * z;
            v[2][p ^ 4][l] = b[6] * x + b[7] * y + b[8] * z;
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) hadamard(v[axis]);
}

/// y += K x over a range of voxels, one after the other.
template <class T>
[[gnu::always_inline]] inline void add_range(const std::array<NodeIndex, 8>* corners, std::size_t count,
                                             const T* blocks, const T* x, T* y) {
    alignas(64) T v[3][8][kLanes] = {};
    for (std::size_t first = 0; first < count; first += kLanes) {
        const std::size_t lanes = std::min(kLanes, count - first);
        for (std::size_t l = 0; l < lanes; ++l)
            for (std::size_t c = 0; c < 8; ++c) {
                const T* from = x + 3 * std::size_t{corners[first + l][c]};
                for (std::size_t axis = 0; axis < 3; ++axis) v[axis][kCornerBits[c]][l] = from[axis];
            }
        multiply(blocks, v);
        for (std::size_t l = 0; l < lanes; ++l)
            for (std::size_t c = 0; c < 8; ++c) {
                T* to = y + 3 * std::size_t{corners[first + l][c]};
                for (std::size_t axis = 0; axis < 3; ++axis) to[axis] += v[axis][kCornerBits[c]][l];
            }
    }
}

template <class T>
void add_range_portable(const std::array<NodeIndex, 8>* corners, std::size_t count, const T* blocks, const T* x, T* y) {
    add_range(corners, count, blocks, x, y);
}
#if defined(__x86_64__)
// The same operations in the same order on wider registers, none fused: the same bits.
template <class T>
FRETWORK_AVX2 void add_range_avx2(const std::array<NodeIndex, 8>* corners, std::size_t count, const T* blocks,
                                  const T* x, T* y) {
    add_range(corners, count, blocks, x, y);
}
#endif

template <class T>
auto chosen_add_range() {
#if defined(__x86_64__)
    if (machine_has_avx2()) return &add_range_avx2<T>;
#endif
    return &add_range_portable<T>;
}

}  // namespace

std::vector<Slab> slabs_of(const VoxelModel& model) {
    const auto layer = [](const std::vector<VoxelCoord>& cells, std::int32_t z) {
        const auto at = std::ranges::lower_bound(cells, z, {}, [](const VoxelCoord& c) { return c[2]; });
        return static_cast<std::uint32_t>(at - cells.begin());
    };
    std::vector<Slab> slabs;
    std::uint32_t voxel = 0, node = 0;
    for (std::int32_t z = 2; z < model.grid.extent[2] + 2; z += 2) {
        const std::uint32_t end = layer(model.voxels, z);
        if (end - voxel < kLeastVoxels && z < model.grid.extent[2]) continue;
        // The last slab holds the topmost nodes as well.
        const auto all = static_cast<std::uint32_t>(model.nodes.size());
        const std::uint32_t end_node = z < model.grid.extent[2] ? layer(model.nodes, z) : all;
        slabs.push_back({voxel, end, node, end_node});
        voxel = end;
        node = end_node;
    }
    return slabs;
}

FineLevel::FineLevel(const VoxelModel& model, const CubeElement& cube, const std::vector<std::uint8_t>& fixed)
    : model_(model), slabs_(slabs_of(model)), around_(model.nodes.size(), 0) {
    for (std::size_t p = 0; p < 8; ++p)
        for (std::size_t k = 0; k < 9; ++k) {
            const double entry = cube.blocks[p](static_cast<int>(k / 3), static_cast<int>(k % 3));
            blocks_[9 * p + k] = entry;
            blocks_float_[9 * p + k] = static_cast<float>(entry);
        }
    for (const auto& corners : model.corners)
        for (std::size_t c = 0; c < 8; ++c)
            // Seen from the corner the voxel lies on the other side.
            around_[corners[c]] = static_cast<std::uint8_t>(around_[corners[c]] | 1u << (7 - kCornerBits[c]));
    for (std::uint32_t n = 0; n < fixed.size(); ++n)
        if (fixed[n] != 0) fixed_.push_back(n);
    invert_diagonal(cube);
    estimate_largest();
}

void FineLevel::invert_diagonal(const CubeElement& cube) {
    for (std::size_t mask = 1; mask < 256; ++mask) {
        Eigen::Matrix3d diagonal = Eigen::Matrix3d::Zero();
        for (std::size_t c = 0; c < 8; ++c)
            if ((mask >> (7 - kCornerBits[c]) & 1) != 0)
                diagonal += cube.stiffness.block<3, 3>(static_cast<int>(3 * c), static_cast<int>(3 * c));
        const Eigen::Matrix3d inverse = diagonal.inverse();
        for (std::size_t k = 0; k < 9; ++k)
            inverse_[mask][k] = static_cast<float>(inverse(static_cast<int>(k / 3), static_cast<int>(k % 3)));
    }
}

template <class T>
void FineLevel::add_products(const NodeValues<T>& x, NodeValues<T>& y) const {
    const auto add = chosen_add_range<T>();
    const T* blocks = nullptr;
    if constexpr (std::is_same_v<T, float>)
        blocks = blocks_float_.data();
    else
        blocks = blocks_.data();
    parallel_chunks(y.size(), 8 * kGrain,
                    [&](std::size_t begin, std::size_t end) { std::fill(y.data() + begin, y.data() + end, T{0}); });
    for_each_slab(slabs_, [&](const Slab& slab) {
        add(model_.corners.data() + slab.first_voxel, slab.end_voxel - slab.first_voxel, blocks, x.data(), y.data());
    });
}

void FineLevel::apply_everywhere(const NodeValues<double>& x, NodeValues<double>& y) const {
    add_products(x, y);
}

void FineLevel::apply(const NodeValues<double>& x, NodeValues<double>& y) const {
    add_products(x, y);
    for (const std::uint32_t n : fixed_)
        y[3 * std::size_t{n}] = y[3 * std::size_t{n} + 1] = y[3 * std::size_t{n} + 2] = 0.0;
}

void FineLevel::apply(const NodeValues<float>& x, NodeValues<float>& y) const {
    add_products(x, y);
    for (const std::uint32_t n : fixed_)
        y[3 * std::size_t{n}] = y[3 * std::size_t{n} + 1] = y[3 * std::size_t{n} + 2] = 0.0F;
}

template <class Use>
void FineLevel::for_each_scaled(const NodeValues<float>& r, const Use& use) const {
    parallel_for(nodes(), kGrain, [&](std::size_t n) {
        const std::array<float, 9>& inverse = inverse_[around_[n]];
        const float* at = r.data() + 3 * n;
        for (std::size_t k = 0; k < 3; ++k)
            use(3 * n + k, inverse[3 * k] * at[0] + inverse[3 * k + 1] * at[1] + inverse[3 * k + 2] * at[2]);
    });
}

void FineLevel::smooth(NodeValues<float>& x, NodeValues<float>& r, NodeValues<float>& d, NodeValues<float>& w) const {
    // What the coarse level sees are the eigenvalues below a twelfth of the largest (Adams et al. 2003).
    const float high = largest_, low = largest_ / 12.0F;
    const float middle = 0.5F * (high + low), half = 0.5F * (high - low);
    const float sigma = middle / half;
    float rho = 1.0F / sigma;
    for_each_scaled(r, [&](std::size_t i, float scaled) {
        d[i] = scaled / middle;
        x[i] += d[i];
    });
    for (int step = 1; step < 3; ++step) {
        apply(d, w);
        parallel_for(r.size(), 4 * kGrain, [&](std::size_t i) { r[i] -= w[i]; });
        const float next = 1.0F / (2.0F * sigma - rho);
        const float keep = next * rho, add = 2.0F * next / half;
        for_each_scaled(r, [&](std::size_t i, float scaled) {
            d[i] = keep * d[i] + add * scaled;
            x[i] += d[i];
        });
        rho = next;
    }
    apply(d, w);
    parallel_for(r.size(), 4 * kGrain, [&](std::size_t i) { r[i] -= w[i]; });
}

void FineLevel::estimate_largest() {
    NodeValues<float> x(3 * nodes()), y(3 * nodes());
    parallel_for(x.size(), 4 * kGrain, [&](std::size_t i) {
        x[i] = static_cast<float>(unit_interval(counter_random(0, RandomStream::kStrength, 0, i, 0)) - 0.5);
    });
    for (const std::uint32_t n : fixed_)
        x[3 * std::size_t{n}] = x[3 * std::size_t{n} + 1] = x[3 * std::size_t{n} + 2] = 0.0F;
    double growth = 1.0;
    for (int turn = 0; turn < 12; ++turn) {
        apply(x, y);
        const auto squared = [&](const NodeValues<float>& v) {
            return sum_in_fixed_order(v.size(), 4 * kGrain, 0.0,
                                      [&](std::size_t i) { return double{v[i]} * double{v[i]}; });
        };
        const double before = std::sqrt(squared(x));
        for_each_scaled(y, [&](std::size_t i, float scaled) { x[i] = scaled; });
        const double after = std::sqrt(squared(x));
        if (!(after > 0.0)) break;
        growth = after / before;
        const auto factor = static_cast<float>(1.0 / after);
        parallel_for(x.size(), 4 * kGrain, [&](std::size_t i) { x[i] *= factor; });
    }
    largest_ = static_cast<float>(1.1 * growth);
}

}  // namespace fretwork
