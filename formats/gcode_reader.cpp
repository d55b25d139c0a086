#include "formats/gcode_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"

namespace fretwork {
namespace {

constexpr double kMostSpacingMm = 0.4;    // of the points along a line
constexpr double kFarthestMm = 10'000.0;  // no printer reaches as far
constexpr std::size_t kMostPoints = 50'000'000;
constexpr double kGapShare = 0.5;  // of a layer's height, before a step up counts as a gap

/// A number at the start of the text, which is moved behind it.
std::optional<double> take_number(std::string_view& text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// "1d 2h 3m 4s"
std::optional<double> seconds_of(std::string_view text) {
    double sum = 0.0;
    while (const auto value = take_number(text)) {
        if (text.empty()) break;
        const char unit = text.front();
        text.remove_prefix(1);
        sum += *value * (unit == 'd' ? 86400.0 : unit == 'h' ? 3600.0 : unit == 'm' ? 60.0 : 1.0);
    }
    return sum > 0.0 ? std::optional(sum) : std::nullopt;
}

/// "0x0,220x0,220x220,0x220": corners of the bed.
void read_bed(std::string_view text, std::array<Vec3, 2>& room) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Vec2 low(kFar, kFar), high(-kFar, -kFar);
    while (const auto x = take_number(text)) {
        if (text.empty() || text.front() != 'x') return;
        text.remove_prefix(1);
        const auto y = take_number(text);
        if (!y) return;
        low = low.cwiseMin(Vec2(*x, *y));
        high = high.cwiseMax(Vec2(*x, *y));
        if (!text.empty()) text.remove_prefix(1);
    }
    if (low[0] < high[0]) room[0].head<2>() = low, room[1].head<2>() = high;
}

/// PrusaSlicer's names, and CuraEngine's in capitals.
bool belongs_to_object(std::string_view type) {
    constexpr std::array<std::string_view, 7> kOthers = {"Skirt", "Support", "Wipe",       "Custom",
                                                         "SKIRT", "SUPPORT", "PRIME-TOWER"};
    return std::ranges::none_of(kOthers, [&](std::string_view other) { return type.starts_with(other); });
}

class Follower {
  public:
    explicit Follower(std::string_view source) : source_(source) {}

    void line(std::string_view text) {
        if (text.starts_with(";")) return comment(text.substr(1));
        text = text.substr(0, text.find(';'));
        const std::string_view command = text.substr(0, text.find(' '));
        if (command == "G0" || command == "G1")
            move(text.substr(command.size()));
        else if (command == "G90" || command == "G91")
            relative_ = relative_e_ = command == "G91";
        else if (command == "M82" || command == "M83")
            relative_e_ = command == "M83";
        else if (command == "G92")
            set(text.substr(command.size()));
    }

    SlicedPrint finish() {
        if (printed_.layers.empty()) throw InvalidInput(std::string(source_) + ": no line is printed in this G-code");
        if (has_bed_) {
            room_[1][2] = height_ > 0.0 ? height_ : std::numeric_limits<double>::infinity();
            printed_.room_mm = room_;
        }
        double below = 0.0;
        for (const PrintedLayer& layer : printed_.layers) {
            const double bottom = layer.top_mm - layer.height_mm;
            if (bottom > below + kGapShare * layer.height_mm) printed_.empty_between_mm.emplace_back(below, bottom);
            below = std::max(below, layer.top_mm);
        }
        return std::move(printed_);
    }

  private:
    void comment(std::string_view text) {
        const auto after = [&](std::string_view key) -> std::optional<std::string_view> {
            if (!text.starts_with(key)) return std::nullopt;
            return text.substr(key.size());
        };
        const auto number = [&](std::string_view key) -> std::optional<double> {
            auto rest = after(key);
            return rest ? take_number(*rest) : std::nullopt;
        };
        if (const auto type = after("TYPE:"))
            object_ = belongs_to_object(*type);
        else if (text.starts_with("LAYER_COUNT:"))
            start_over();
        else if (const auto z = number("Z:"))
            layer_top_ = *z;
        else if (const auto height = number("HEIGHT:"))
            layer_height_ = *height;
        else if (const auto time = after(" estimated printing time (normal mode) = "))
            printed_.seconds = seconds_of(*time);
        else if (const auto mm = number(" filament used [mm] ="))
            printed_.filament_mm = mm;
        else if (const auto cm3 = number(" filament used [cm3] ="))
            printed_.material_ml = cm3;
        else if (const auto grams = number(" filament used [g] ="))
            printed_.filament_g = grams;
        else if (const auto width = number(" external perimeters extrusion width ="))
            printed_.line_mm = width;
        else if (const auto bed = after(" bed_shape = ")) {
            read_bed(*bed, room_);
            has_bed_ = true;
        } else if (const auto high = number(" max_print_height ="))
            height_ = *high;
    }

    /// CuraEngine says when the model begins; what was printed before cleaned the nozzle.
    void start_over() {
        printed_.layers.clear();
        any_ = false;
    }

    /// Calls `found(letter, value)` for each word.
    template <class Found>
    static void words(std::string_view text, const Found& found) {
        while (!text.empty()) {
            const char letter = text.front();
            text.remove_prefix(1);
            if (letter == ' ' || letter == '\t' || letter == '\r') continue;
            if (const auto value = take_number(text)) found(letter, *value);
        }
    }

    void move(std::string_view text) {
        const Vec3 from = at_;
        double pushed = 0.0;
        words(text, [&](char letter, double value) {
            if (letter >= 'X' && letter <= 'Z') {
                double& axis = at_[letter - 'X'];
                axis = relative_ ? axis + value : value;
            } else if (letter == 'E') {
                pushed = relative_e_ ? value : value - e_;
                e_ = relative_e_ ? e_ + value : value;
            }
        });
        if (pushed > 0.0 && (at_ - from).head<2>().norm() > 0.0) print(from, at_);
    }

    void set(std::string_view text) {
        words(text, [&](char letter, double value) {
            if (letter >= 'X' && letter <= 'Z') at_[letter - 'X'] = value;
            if (letter == 'E') e_ = value;
        });
    }

    void print(const Vec3& from, const Vec3& to) {
        const bool first = printed_.layers.empty() && !any_;
        any_ = true;
        printed_.min_mm = first ? from.cwiseMin(to) : Vec3(printed_.min_mm.cwiseMin(from).cwiseMin(to));
        printed_.max_mm = first ? from.cwiseMax(to) : Vec3(printed_.max_mm.cwiseMax(from).cwiseMax(to));
        if (!object_) return;
        const double top = layer_top_.value_or(to[2]);
        if (printed_.layers.empty() || top > printed_.layers.back().top_mm) {
            const double below = printed_.layers.empty() ? 0.0 : printed_.layers.back().top_mm;
            printed_.layers.push_back({top, layer_height_.value_or(top - below), {}});
        }
        const Vec2 a = from.head<2>(), b = to.head<2>();
        if (from.cwiseAbs().maxCoeff() > kFarthestMm || to.cwiseAbs().maxCoeff() > kFarthestMm)
            throw InvalidInput(std::string(source_) + ": found a line that ends over 10 m from the origin");
        const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / kMostSpacingMm)));
        points_ += static_cast<std::size_t>(steps) + 1;
        if (points_ > kMostPoints) throw InvalidInput(std::string(source_) + ": found over 20 km of lines");
        for (int i = 0; i <= steps; ++i) printed_.layers.back().points_mm.emplace_back(a + (b - a) * i / steps);
    }

    std::string_view source_;
    SlicedPrint printed_;
    std::size_t points_ = 0;
    std::array<Vec3, 2> room_ = {Vec3::Zero(), Vec3::Zero()};
    bool has_bed_ = false;
    double height_ = 0.0;
    Vec3 at_ = Vec3::Zero();
    double e_ = 0.0;
    bool relative_ = false, relative_e_ = false, object_ = true, any_ = false;
    std::optional<double> layer_top_, layer_height_;
};

}  // namespace

SlicedPrint read_gcode(std::string_view text, std::string_view source) {
    Follower follower(source);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        follower.line(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return follower.finish();
}

}  // namespace fretwork
