#include "core/pipeline/settings_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/pipeline/region_schema.h"

namespace fretwork {
namespace {

std::string at(std::string_view place) {
    return place.empty() ? std::string{} : fmt::format("{}: ", place);
}

[[noreturn]] void reject(const SettingInfo& info, const SettingAssignment& assignment) {
    throw InvalidSetting(fmt::format("{}{} = {}: expected {}", at(assignment.place), info.key,
                                     setting_text(assignment.value), describe_range(info)));
}

bool in_range(const SettingInfo& info, double number) {
    if (!std::isfinite(number)) return false;
    if (!info.range) return true;
    return (info.range->min_excluded ? number > info.range->min : number >= info.range->min) &&
           number <= info.range->max;
}

bool is_direction(const SettingValue& value) {
    const auto* list = std::get_if<std::vector<double>>(&value);
    if (!list || list->size() != 3) return false;
    const bool finite = std::ranges::all_of(*list, [](double x) { return std::isfinite(x) && std::abs(x) < 1e100; });
    return finite && std::ranges::any_of(*list, [](double x) { return std::abs(x) > 1e-100; });
}

// The value in the form that the key's setter takes, or nothing if it has none.
std::optional<SettingValue> coerced(const SettingInfo& info, const SettingValue& value) {
    switch (info.type) {
        case SettingType::kBool:
            if (std::holds_alternative<bool>(value)) return value;
            break;
        case SettingType::kInteger:
            if (const auto* integer = std::get_if<std::int64_t>(&value))
                if (in_range(info, static_cast<double>(*integer))) return value;
            break;
        case SettingType::kNumber: {
            std::optional<double> number;
            if (const auto* integer = std::get_if<std::int64_t>(&value)) number = static_cast<double>(*integer);
            if (const auto* real = std::get_if<double>(&value)) number = *real;
            if (number && in_range(info, *number)) return *number;
            break;
        }
        case SettingType::kText:
            if (std::holds_alternative<std::string>(value)) return value;
            break;
        case SettingType::kChoice:
            if (const auto* name = std::get_if<std::string>(&value))
                if (std::ranges::count(info.choices, *name) > 0) return value;
            break;
        case SettingType::kDirection:
            if (is_direction(value)) return value;
            break;
        case SettingType::kOrientation:
            if (const auto* name = std::get_if<std::string>(&value))
                if (*name == "up" || *name == "free") return value;
            if (is_direction(value)) return value;
            break;
    }
    return std::nullopt;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    const auto from = text.find_first_not_of(blanks);
    if (from == std::string_view::npos) return {};
    return text.substr(from, text.find_last_not_of(blanks) - from + 1);
}

template <class Number>
std::optional<Number> parsed(std::string_view text) {
    Number number{};
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return number;
}

// "[0, 0, 1]" or "0,0,1".
std::optional<std::vector<double>> parsed_list(std::string_view text) {
    if (text.starts_with('[') && text.ends_with(']')) text = text.substr(1, text.size() - 2);
    std::vector<double> list;
    while (true) {
        const auto comma = text.find(',');
        const auto number = parsed<double>(trimmed(text.substr(0, comma)));
        if (!number) return std::nullopt;
        list.push_back(*number);
        if (comma == std::string_view::npos) return list;
        text.remove_prefix(comma + 1);
    }
}

// Text that is not of the wanted form stays text, so that the error shows what was typed.
SettingValue value_from_text(SettingType type, std::string_view text) {
    const std::string_view bare = trimmed(text);
    switch (type) {
        case SettingType::kBool:
            if (bare == "true" || bare == "1") return true;
            if (bare == "false" || bare == "0") return false;
            break;
        case SettingType::kInteger:
            if (const auto integer = parsed<std::int64_t>(bare)) return *integer;
            break;
        case SettingType::kNumber:
            if (const auto number = parsed<double>(bare)) return *number;
            break;
        case SettingType::kDirection:
        case SettingType::kOrientation:
            if (const auto list = parsed_list(bare)) return *list;
            break;
        case SettingType::kText:
        case SettingType::kChoice:
            break;
    }
    std::string_view unquoted = bare;
    if (bare.size() >= 2 && (bare.front() == '"' || bare.front() == '\'') && bare.back() == bare.front())
        unquoted = bare.substr(1, bare.size() - 2);
    return std::string(unquoted);
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string> known) {
    std::string best;
    std::size_t best_distance = 0;
    for (const std::string& candidate : known) {
        // A name without its section counts as close to the key that ends in it.
        const auto dot = candidate.rfind('.');
        std::size_t distance = edit_distance(name, candidate);
        if (dot != std::string::npos) distance = std::min(distance, edit_distance(name, candidate.substr(dot + 1)) + 1);
        if (best.empty() || distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

const SettingInfo& setting_info(std::string_view key, std::string_view place) {
    const auto all = all_settings();
    const auto found = std::ranges::find(all, key, &SettingInfo::key);
    if (found != all.end()) return *found;
    std::vector<std::string> known;
    for (const SettingInfo& info : all) known.push_back(info.key);
    throw InvalidSetting(
        fmt::format("{}unknown setting '{}'; did you mean '{}'?", at(place), key, nearest_name(key, known)));
}

void apply_setting(Settings& settings, const SettingAssignment& assignment) {
    const SettingInfo& info = setting_info(assignment.key, assignment.place);
    const std::optional<SettingValue> value = coerced(info, assignment.value);
    if (!value) reject(info, assignment);
    info.set(settings, *value);
}

SettingAssignment parse_setting(std::string_view key, std::string_view text, std::string_view place) {
    const SettingInfo& info = setting_info(key, place);
    SettingAssignment assignment{info.key, value_from_text(info.type, text), std::string(place)};
    if (!coerced(info, assignment.value)) reject(info, assignment);
    return assignment;
}

SettingAssignment parse_assignment(std::string_view key_and_value, std::string_view place) {
    const auto equals = key_and_value.find('=');
    if (equals == std::string_view::npos)
        throw InvalidSetting(fmt::format("{}'{}': expected key=value", at(place), key_and_value));
    return parse_setting(trimmed(key_and_value.substr(0, equals)), key_and_value.substr(equals + 1), place);
}

Settings settings_from(const SpecDocument& document) {
    Settings settings;
    for (const SettingAssignment& assignment : document.assignments)
        if (assignment.key == "synthesis.preset") apply_setting(settings, assignment);
    apply_preset(settings, settings.synthesis.preset);
    // A voxel size replaces the preset's resolution; beside a resolution that was given it is a contradiction.
    if (std::ranges::count(document.assignments, "shell.voxel_mm", &SettingAssignment::key) > 0)
        settings.shell.resolution.reset();
    for (const SettingAssignment& assignment : document.assignments)
        if (assignment.key != "synthesis.preset") apply_setting(settings, assignment);
    for (const SettingTable& table : document.tables) apply_table(settings, table);
    return settings;
}

SpecDocument document_from(const Settings& settings) {
    SpecDocument document;
    for (const SettingInfo& info : all_settings())
        if (const auto value = info.get(settings)) document.assignments.push_back({info.key, *value, {}});
    document.tables = tables_from(settings);
    return document;
}

std::string describe_range(const SettingInfo& info) {
    const std::string unit = info.unit == "1" ? std::string{} : " " + info.unit;
    switch (info.type) {
        case SettingType::kBool:
            return "true or false";
        case SettingType::kText:
            return "text";
        case SettingType::kChoice:
            return fmt::format("one of {}", fmt::join(info.choices, ", "));
        case SettingType::kDirection:
            return "a direction [x, y, z] that is not zero";
        case SettingType::kOrientation:
            return "\"up\", \"free\" or a direction [x, y, z] that is not zero";
        case SettingType::kInteger:
        case SettingType::kNumber:
            break;
    }
    const std::string what = info.type == SettingType::kInteger ? "a whole number" : "a number";
    if (!info.range) return what;
    if (info.range->min_excluded)
        return fmt::format("{} above {:g} and up to {:g}{}", what, info.range->min, info.range->max, unit);
    return fmt::format("{} from {:g} to {:g}{}", what, info.range->min, info.range->max, unit);
}

}  // namespace fretwork
