#include "core/render/contact_sheet.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>

#include "core/base/error.h"

namespace fretwork {
namespace {

/// Where each cell of one axis starts, and the total length, from the longest side in each.
std::vector<int> starts(const std::vector<int>& longest, int gap_px) {
    std::vector<int> start(longest.size() + 1, 0);
    for (std::size_t i = 0; i < longest.size(); ++i) start[i + 1] = start[i] + longest[i] + gap_px;
    start.back() -= gap_px;
    return start;
}

}  // namespace

Image contact_sheet(std::span<const Image> pictures, int columns, int gap_px, const Rgb8& paper) {
    if (pictures.empty() || columns < 1 || gap_px < 0)
        throw InvalidInput("contact_sheet: " + std::to_string(pictures.size()) + " pictures in " +
                           std::to_string(columns) + " columns with gaps of " + std::to_string(gap_px) +
                           " px; expected at least one of each and no negative gap");
    const auto across = std::min(static_cast<std::size_t>(columns), pictures.size());
    std::vector<int> width(across, 0), height((pictures.size() + across - 1) / across, 0);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const Image& p = pictures[i];
        if (p.width < 1 || p.height < 1 ||
            p.pixels.size() != static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height))
            throw InvalidInput("contact_sheet: picture " + std::to_string(i) + " is empty or not of its size");
        width[i % across] = std::max(width[i % across], p.width);
        height[i / across] = std::max(height[i / across], p.height);
    }
    const std::vector<int> left = starts(width, gap_px), top = starts(height, gap_px);
    Image sheet{left.back(), top.back(), {}, false};
    sheet.pixels.assign(static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height),
                        {paper[0], paper[1], paper[2], 255});
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const Image& p = pictures[i];
        const int x0 = left[i % across] + (width[i % across] - p.width) / 2;
        const int y0 = top[i / across] + (height[i / across] - p.height) / 2;
        for (int y = 0; y < p.height; ++y)
            std::copy_n(p.pixels.begin() + static_cast<std::ptrdiff_t>(y) * p.width, p.width,
                        sheet.pixels.begin() + static_cast<std::ptrdiff_t>(y0 + y) * sheet.width + x0);
    }
    return sheet;
}

Image render_around(const TriangleMesh& mesh, std::span<const Rgb8> triangle_colors,
                    std::span<const double> azimuths_deg, const RenderSettings& settings, const RunControl& run) {
    std::vector<Image> views;
    for (std::size_t i = 0; i < azimuths_deg.size(); ++i) {
        RenderSettings view = settings;
        view.azimuth_deg = azimuths_deg[i];
        const double count = static_cast<double>(azimuths_deg.size());
        views.push_back(render(mesh, triangle_colors, view,
                               run.slice(static_cast<double>(i) / count, static_cast<double>(i + 1) / count)));
    }
    return contact_sheet(views, static_cast<int>(views.size()));
}

}  // namespace fretwork
