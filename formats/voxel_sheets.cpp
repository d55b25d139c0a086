#include "formats/voxel_sheets.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/exemplar/color_space.h"
#include "formats/png_writer.h"

namespace fretwork {
namespace {

constexpr std::int32_t kMaxCells = 1024;  ///< along one axis, a limit of the extension
constexpr std::uint16_t kOne = 65535;

std::array<std::uint16_t, 256> make_linear_table() {
    std::array<std::uint16_t, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double linear = srgb_to_linear(static_cast<double>(i) / 255.0);
        table[i] = static_cast<std::uint16_t>(std::lround(kOne * linear));
    }
    return table;
}

void check_data(const VoxelData& data) {
    const SurfaceVoxels& shell = data.shell;
    const auto check = [&](std::size_t count, const char* what, bool may_be_empty) {
        if (count != shell.size() && !(may_be_empty && count == 0))
            throw InvalidInput("write voxel data: found " + std::to_string(count) + " values of " + what +
                               ", expected " + std::to_string(shell.size()) + ", one per voxel");
    };
    check(data.solid.size(), "solid", false);
    check(data.reinforced.size(), "reinforced", true);
    check(data.colors.size(), "colour", true);
    check(data.stress_mpa.size(), "stress", true);
    check(data.labels.size(), "label", true);
    for (const std::int32_t cells : shell.grid.extent)
        if (cells < 1 || cells > kMaxCells)
            throw InvalidInput("write voxel data: found a grid of " + std::to_string(cells) +
                               " cells along an axis, expected 1 to 1024, the most that 3MF can hold");
    for (const VoxelCoord& c : shell.coords)
        for (std::size_t k = 0; k < 3; ++k)
            if (c[k] < 0 || c[k] >= shell.grid.extent[k])
                throw InvalidInput("write voxel data: found a voxel outside of the grid");
}

/// Entries of the shell are sorted by z: where each z begins.
std::vector<std::size_t> first_of_sheet(const SurfaceVoxels& shell) {
    std::vector<std::size_t> first(static_cast<std::size_t>(shell.grid.extent[2]) + 1, 0);
    for (const VoxelCoord& c : shell.coords) ++first[static_cast<std::size_t>(c[2]) + 1];
    for (std::size_t z = 1; z < first.size(); ++z) first[z] += first[z - 1];
    for (std::size_t v = 1; v < shell.size(); ++v)
        if (shell.coords[v][2] < shell.coords[v - 1][2])
            throw InvalidInput("write voxel data: found voxels out of order, expected them sorted by z");
    return first;
}

class SheetMaker {
  public:
    explicit SheetMaker(const VoxelData& data) : data_(data), first_(first_of_sheet(data.shell)) {}

    [[nodiscard]] std::string field(std::size_t z) const {
        std::vector<std::uint16_t> samples(4 * cells(), 0);
        for (std::size_t v = first_[z]; v < first_[z + 1]; ++v) {
            std::uint16_t* cell = samples.data() + 4 * cell_of(v);
            const bool solid = data_.solid[v] == SolidState::kSolid;
            const bool colored_before = cell[0] != 0 || cell[1] != 0 || cell[2] != 0;
            // Of several sheets of the surface in one cell the first solid one gives the colour.
            if (!data_.colors.empty() && (!colored_before || (solid && cell[3] == 0)))
                for (std::size_t k = 0; k < 3; ++k) cell[k] = linear_[data_.colors[v][k]];
            if (solid) cell[3] = kOne;
        }
        return write_png16(samples, width(), height(), 4);
    }

    [[nodiscard]] std::string reinforced(std::size_t z) const {
        std::vector<std::uint8_t> samples(cells(), 0);
        for (std::size_t v = first_[z]; v < first_[z + 1]; ++v)
            if (data_.reinforced[v] != 0) samples[cell_of(v)] = 255;
        return write_png_gray8(samples, width(), height());
    }

    /// Sheet z of the cells that are twice as large.
    [[nodiscard]] std::string facts(std::size_t z, const VoxelGrid& grid, double most_stress_mpa) const {
        const auto columns = static_cast<std::size_t>(grid.extent[0]), rows = static_cast<std::size_t>(grid.extent[1]);
        std::vector<std::uint16_t> samples(3 * columns * rows, 0);
        for (std::size_t v = first_[2 * z]; v < first_[std::min(2 * z + 2, first_.size() - 1)]; ++v) {
            const VoxelCoord& c = data_.shell.coords[v];
            const std::size_t row = rows - 1 - static_cast<std::size_t>(c[1]) / 2;
            std::uint16_t* cell = samples.data() + 3 * (row * columns + static_cast<std::size_t>(c[0]) / 2);
            // Where it is known to be next to nothing it is not 0.
            if (most_stress_mpa > 0.0 && data_.stress_mpa[v] >= 0.0F) {
                const double share = static_cast<double>(data_.stress_mpa[v]) / most_stress_mpa;
                cell[0] = std::max({cell[0], std::uint16_t{1}, static_cast<std::uint16_t>(std::lround(kOne * share))});
            }
            if (cell[1] == 0 && !data_.labels.empty()) cell[1] = data_.labels[v];
        }
        return write_png16(samples, grid.extent[0], grid.extent[1], 3);
    }

  private:
    [[nodiscard]] int width() const { return data_.shell.grid.extent[0]; }
    [[nodiscard]] int height() const { return data_.shell.grid.extent[1]; }
    [[nodiscard]] std::size_t cells() const {
        return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    }
    [[nodiscard]] std::size_t cell_of(std::size_t v) const {
        const VoxelCoord& c = data_.shell.coords[v];
        return static_cast<std::size_t>(height() - 1 - c[1]) * static_cast<std::size_t>(width()) +
               static_cast<std::size_t>(c[0]);
    }

    const VoxelData& data_;
    std::vector<std::size_t> first_;
    std::array<std::uint16_t, 256> linear_ = make_linear_table();
};

VoxelGrid twice_as_coarse(VoxelGrid grid) {
    grid.voxel_mm *= 2.0;
    for (std::int32_t& cells : grid.extent) cells = (cells + 1) / 2;
    return grid;
}

}  // namespace

VoxelSheets make_voxel_sheets(const VoxelData& data, const RunControl& run) {
    check_data(data);
    const SheetMaker maker(data);
    VoxelSheets sheets;
    sheets.grid = data.shell.grid;
    sheets.colored = !data.colors.empty();
    sheets.field.resize(static_cast<std::size_t>(data.shell.grid.extent[2]));
    if (!data.reinforced.empty()) sheets.reinforced.resize(sheets.field.size());
    sheets.facts_grid = twice_as_coarse(data.shell.grid);
    if (!data.stress_mpa.empty())
        sheets.most_stress_mpa = std::max(0.0, static_cast<double>(*std::ranges::max_element(data.stress_mpa)));
    if (sheets.most_stress_mpa > 0.0 || !data.labels.empty())
        sheets.facts.resize(static_cast<std::size_t>(sheets.facts_grid.extent[2]));
    parallel_for(sheets.facts.size(), 1, [&](std::size_t z) {
        run.throw_if_stopped();
        sheets.facts[z] = maker.facts(z, sheets.facts_grid, sheets.most_stress_mpa);
    });
    parallel_for(sheets.field.size(), 1, [&](std::size_t z) {
        run.throw_if_stopped();
        sheets.field[z] = maker.field(z);
        if (!sheets.reinforced.empty()) sheets.reinforced[z] = maker.reinforced(z);
    });
    return sheets;
}

}  // namespace fretwork
