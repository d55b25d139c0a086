#include "formats/report_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "formats/color_channel.h"

namespace fretwork {
namespace {

constexpr double kWidth = 640.0;
constexpr std::size_t kClasses = 36;

std::string opening(double height, std::string_view label) {
    return fmt::format("<svg class=\"chart\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">\n", kWidth,
                       height, label);
}

std::string text_at(double x, double y, std::string_view anchor, const std::string& text) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, text);
}

std::string line_at(double x1, double y1, double x2, double y2, std::string_view kind) {
    return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kind, x1, y1,
                       x2, y2);
}

std::vector<double> powers_of_ten(const StressScale& scale) {
    std::vector<double> powers;
    for (double exponent = std::ceil(std::log10(scale.low_mpa) - 1e-9);
         exponent <= std::floor(std::log10(scale.high_mpa) + 1e-9); ++exponent)
        powers.push_back(std::pow(10.0, exponent));
    return powers;
}

/// Share of the samples in each class; what lies outside of the scale is in the first and the last.
std::vector<double> shares(const std::vector<double>& samples_mpa, const StressScale& scale) {
    std::vector<double> share(kClasses, 0.0);
    for (const double mpa : samples_mpa)
        share[std::min(kClasses - 1, static_cast<std::size_t>(scale.place(mpa) * kClasses))] += 1.0;
    for (double& s : share) s /= static_cast<double>(std::max<std::size_t>(1, samples_mpa.size()));
    return share;
}

/// A stepped outline over the classes, down to the axis at both ends.
std::string steps(const std::vector<double>& share, double most, double left, double width, double top, double height) {
    const double step = width / static_cast<double>(kClasses);
    std::string path = fmt::format("M{:.1f} {:.1f}", left, top + height);
    for (std::size_t i = 0; i < kClasses; ++i)
        path += fmt::format("V{:.1f}h{:.2f}", top + height * (1.0 - share[i] / most), step);
    return path + fmt::format("V{:.1f}Z", top + height);
}

/// Counts in full, the rest in three digits.
std::string short_number(double value) {
    return value == std::floor(value) && std::abs(value) < 1e9 ? fmt::format("{:.0f}", value)
                                                               : fmt::format("{:.3g}", value);
}

/// A panel of the chart of iterations: a value per turn, as bars.
struct Panel {
    std::string title, kind;
    std::vector<double> values;
    std::string unit;
};

std::string panel_svg(const Panel& panel, double top, double height) {
    const double left = 60.0, right = 16.0;
    const double most = std::max(1e-12, *std::ranges::max_element(panel.values));
    const double slot = (kWidth - left - right) / static_cast<double>(panel.values.size());
    const double bar = std::min(48.0, 0.6 * slot);
    std::string svg = text_at(left, top - 26.0, "start", panel.title);
    svg += line_at(left, top + height, kWidth - right, top + height, "axis");
    for (std::size_t i = 0; i < panel.values.size(); ++i) {
        const double middle = left + (static_cast<double>(i) + 0.5) * slot;
        const double h = height * panel.values[i] / most;
        svg += fmt::format(
            "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"><title>turn {}: "
            "{:.4g}{}</title></rect>\n",
            panel.kind, middle - bar / 2.0, top + height - h, bar, h, i + 1, panel.values[i], panel.unit);
        if (panel.values.size() <= 12)
            svg += text_at(middle, top + height - h - 4.0, "middle", short_number(panel.values[i]));
    }
    return svg;
}

}  // namespace

std::string stress_histogram(const ShellStress& stress, const StressScale& scale) {
    const double left = 68.0, right = 16.0, top = 34.0, height = 200.0, width = kWidth - left - right;
    const std::vector<double> before = shares(stress.before.samples_mpa, scale);
    const std::vector<double> after = shares(stress.after.samples_mpa, scale);
    const double most = std::max({0.01, *std::ranges::max_element(before), *std::ranges::max_element(after)});
    std::string svg = opening(top + height + 48.0, "Histogram of stress before and after reinforcement");
    for (const double share : {0.5, 1.0}) {
        const double y = top + height * (1.0 - share);
        svg += line_at(left, y, kWidth - right, y, "grid");
        svg += text_at(left - 6.0, y + 4.0, "end", fmt::format("{:.3g} %", 100.0 * share * most));
    }
    for (const double mpa : powers_of_ten(scale)) {
        const double x = left + width * scale.place(mpa);
        svg += line_at(x, top, x, top + height, "grid");
        svg += text_at(x, top + height + 18.0, "middle", fmt::format("{:g}", mpa));
    }
    svg += fmt::format("<path class=\"before\" d=\"{}\"/>\n", steps(before, most, left, width, top, height));
    svg += fmt::format("<path class=\"after\" d=\"{}\"/>\n", steps(after, most, left, width, top, height));
    const double limit = scale.place(stress.allowable_mpa);
    if (limit > 0.0 && limit < 1.0) {
        const double x = left + width * limit;
        svg += line_at(x, top, x, top + height, "limit");
        svg += text_at(x - 4.0, top + 12.0, "end", "allowable");
    }
    svg += line_at(left, top + height, kWidth - right, top + height, "axis");
    svg += fmt::format("<rect class=\"before\" x=\"{0:.0f}\" y=\"8\" width=\"14\" height=\"14\"/>\n", left);
    svg += text_at(left + 20.0, 20.0, "start", "before");
    svg += fmt::format("<rect class=\"after\" x=\"{0:.0f}\" y=\"8\" width=\"14\" height=\"14\"/>\n", left + 90.0);
    svg += text_at(left + 110.0, 20.0, "start", "after reinforcement");
    svg += text_at(left + width / 2.0, top + height + 40.0, "middle",
                   fmt::format("stress in MPa; share of {}", stress.sample_name));
    return svg + "</svg>\n";
}

std::string iteration_chart(const std::vector<ReinforceRecord>& turns) {
    if (turns.empty()) return {};
    Panel pieces{"Pieces that do not touch", "pieces", {}, " pieces"};
    Panel stress{"Highest stress, MPa", "stress", {}, " MPa"};
    Panel added{"Voxels added", "added", {}, " voxels"};
    for (const ReinforceRecord& turn : turns) {
        pieces.values.push_back(static_cast<double>(turn.components_before));
        stress.values.push_back(1e-6 * turn.max_score_pa);
        added.values.push_back(static_cast<double>(turn.voxels_added));
    }
    const double height = 80.0, pitch = 150.0;
    std::string svg = opening(3.0 * pitch + 14.0, "Pieces, highest stress and voxels added in each turn");
    double top = 46.0;
    for (const Panel* panel : {&pieces, &stress, &added}) {
        svg += panel_svg(*panel, top, height);
        top += pitch;
    }
    const double slot = (kWidth - 76.0) / static_cast<double>(turns.size());
    const std::size_t every = (turns.size() + 11) / 12;
    for (std::size_t i = 0; i < turns.size(); i += every)
        svg += text_at(60.0 + (static_cast<double>(i) + 0.5) * slot, top - pitch + height + 18.0, "middle",
                       fmt::format("turn {}", turns[i].iteration));
    return svg + "</svg>\n";
}

std::string stress_legend(const StressScale& scale) {
    constexpr int kStops = 16;
    std::string svg =
        "<svg class=\"legend\" viewBox=\"0 0 640 44\" role=\"img\" aria-label=\"Colours of stress in MPa\">\n";
    const double width = 600.0 / kStops;
    for (int i = 0; i < kStops; ++i)
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"2\" width=\"{:.1f}\" height=\"18\" fill=\"{}\"/>\n",
                           20.0 + i * width, width + 0.5, hex_color(stress_color((i + 0.5) / kStops)));
    for (const double mpa : powers_of_ten(scale))
        svg += text_at(20.0 + 600.0 * scale.place(mpa), 38.0, "middle", fmt::format("{:g} MPa", mpa));
    return svg + "</svg>\n";
}

}  // namespace fretwork
