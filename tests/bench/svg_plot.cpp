#include "svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"

namespace fretwork::bench {
namespace {

constexpr double kWidth = 760, kHeight = 480, kLeft = 70, kRight = 150, kTop = 40, kBottom = 55;
constexpr std::array kColors = {"#1b6ca8", "#d1495b", "#3c8d5a", "#e08e2b", "#7b4fa3",
                                "#4a4a4a", "#17a2a2", "#a0622d", "#c2185b", "#6c8e23"};

bool is_shown(const Vec2& p) {
    return p.x() > 0 && p.y() > 0 && p.allFinite();
}

/// Decades of the axes and the way from values to the picture.
struct Frame {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Zero();

    explicit Frame(const std::vector<PlotSeries>& series) {
        for (const PlotSeries& s : series)
            for (const Vec2& p : s.points)
                if (is_shown(p)) low = low.cwiseMin(p), high = high.cwiseMax(p);
        if (high.x() <= 0) throw InvalidInput("a plot needs at least one point");
        for (int axis = 0; axis < 2; ++axis) {
            low[axis] = std::floor(std::log10(low[axis]));
            high[axis] = std::max(low[axis] + 1, std::ceil(std::log10(high[axis])));
        }
    }
    [[nodiscard]] Vec2 at(const Vec2& value) const {
        const double x = (std::log10(value.x()) - low.x()) / (high.x() - low.x());
        const double y = (std::log10(value.y()) - low.y()) / (high.y() - low.y());
        return {kLeft + x * (kWidth - kLeft - kRight), kHeight - kBottom - y * (kHeight - kTop - kBottom)};
    }
    [[nodiscard]] Vec2 corner_low() const { return {std::pow(10, low.x()), std::pow(10, low.y())}; }
    [[nodiscard]] Vec2 corner_high() const { return {std::pow(10, high.x()), std::pow(10, high.y())}; }
};

std::string text_at(const Vec2& p, std::string_view anchor, std::string_view text, std::string_view more = "") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", p.x(), p.y(), anchor, more,
                       text);
}

std::string line(const Vec2& a, const Vec2& b, std::string_view style) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", a.x(), a.y(), b.x(),
                       b.y(), style);
}

std::string axes(const Frame& frame, const PlotLabels& labels) {
    constexpr std::string_view grid = "stroke=\"#ddd\"";
    std::string svg;
    const Vec2 low = frame.corner_low(), high = frame.corner_high();
    for (int d = static_cast<int>(frame.low.x()); d <= static_cast<int>(frame.high.x()); ++d) {
        const double x = std::pow(10, d);
        svg += line(frame.at({x, low.y()}), frame.at({x, high.y()}), grid);
        svg += text_at(frame.at({x, low.y()}) + Vec2(0, 18), "middle", fmt::format("{:g}", x));
    }
    for (int d = static_cast<int>(frame.low.y()); d <= static_cast<int>(frame.high.y()); ++d) {
        const double y = std::pow(10, d);
        svg += line(frame.at({low.x(), y}), frame.at({high.x(), y}), grid);
        svg += text_at(frame.at({low.x(), y}) + Vec2(-6, 4), "end", fmt::format("{:g}", y));
    }
    svg += text_at({kLeft, 22}, "start", labels.title, " font-weight=\"bold\"");
    svg += text_at({(kLeft + kWidth - kRight) / 2, kHeight - 12}, "middle", labels.x);
    svg += text_at({16, kHeight / 2}, "middle", labels.y,
                   fmt::format(" transform=\"rotate(-90 16 {:.1f})\"", kHeight / 2));
    return svg;
}

/// From the lower left corner on, as far as the frame goes.
std::string slope_one(const Frame& frame) {
    const Vec2 from = frame.corner_low();
    const double decades = std::min(frame.high.x() - frame.low.x(), frame.high.y() - frame.low.y());
    const Vec2 to = from * std::pow(10, decades);
    return line(frame.at(from), frame.at(to), "stroke=\"#999\" stroke-dasharray=\"6 5\"") +
           text_at(frame.at(to) + Vec2(-8, 14), "end", "linear", " fill=\"#777\"");
}

std::string curve(const Frame& frame, const PlotSeries& series, std::size_t number) {
    const std::string_view color = kColors[number % kColors.size()];
    std::string points, dots;
    for (const Vec2& p : series.points) {
        if (!is_shown(p)) continue;
        const Vec2 at = frame.at(p);
        points += fmt::format("{:.1f},{:.1f} ", at.x(), at.y());
        dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", at.x(), at.y(), color);
    }
    const Vec2 legend(kWidth - kRight + 18, kTop + 14 + 20 * static_cast<double>(number));
    return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", points, color) +
           dots + line(legend, legend + Vec2(18, 0), fmt::format("stroke=\"{}\" stroke-width=\"3\"", color)) +
           text_at(legend + Vec2(24, 4), "start", series.name);
}

}  // namespace

std::string log_log_plot(const PlotLabels& labels, const std::vector<PlotSeries>& series) {
    const Frame frame(series);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        kWidth, kHeight);
    svg += axes(frame, labels) + slope_one(frame);
    for (std::size_t i = 0; i < series.size(); ++i) svg += curve(frame, series[i], i);
    return svg + "</svg>\n";
}

double fitted_exponent(const std::vector<Vec2>& points) {
    std::vector<Vec2> logs;
    for (const Vec2& p : points)
        if (is_shown(p)) logs.emplace_back(std::log(p.x()), std::log(p.y()));
    if (logs.size() < 2) throw InvalidInput("a power law needs at least two points");
    Vec2 mean = Vec2::Zero();
    for (const Vec2& p : logs) mean += p / static_cast<double>(logs.size());
    double above = 0.0, below = 0.0;
    for (const Vec2& p : logs) {
        above += (p.x() - mean.x()) * (p.y() - mean.y());
        below += (p.x() - mean.x()) * (p.x() - mean.x());
    }
    return above / below;
}

}  // namespace fretwork::bench
