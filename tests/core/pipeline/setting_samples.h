// Values to try for every key of the table of settings.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/pipeline/settings_schema.h"

namespace fretwork::testing {

/// Values that the key takes; at least one differs from the default.
inline std::vector<SettingValue> good_values(const SettingInfo& info) {
    switch (info.type) {
        case SettingType::kBool:
            return {true, false};
        case SettingType::kText:
            return {std::string("a \"b\" \\ c#\t\xC3\xA4"), std::string("leaves.png")};
        case SettingType::kChoice:
            return {info.choices.begin(), info.choices.end()};
        case SettingType::kDirection:
            return {std::vector<double>{0.1, -2.0, 1e-3}};
        case SettingType::kOrientation:
            return {std::string("free"), std::string("up"), std::vector<double>{1.0, 0.25, 0.0}};
        case SettingType::kInteger: {
            const auto low = static_cast<std::int64_t>(info.range->min),
                       high = static_cast<std::int64_t>(info.range->max);
            return {low, low + (high - low) / 3, high};
        }
        case SettingType::kNumber: {
            const double low = info.range->min, high = info.range->max;
            const double least = info.range->min_excluded ? std::nextafter(low, high) : low;
            return {least, low + (high - low) / 3.0, high};
        }
    }
    return {};
}

/// Values that the key refuses.
inline std::vector<SettingValue> bad_values(const SettingInfo& info) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    switch (info.type) {
        case SettingType::kBool:
            return {std::string("yes"), 0.5};
        case SettingType::kText:
            return {true, std::int64_t{3}, std::vector<double>{1.0}};
        case SettingType::kChoice:
            return {std::string("no such choice"), std::string(""), true};
        case SettingType::kDirection:
            return {std::vector<double>{0.0, 0.0, 0.0}, std::vector<double>{1.0, 2.0},
                    std::vector<double>{nan, 0.0, 1.0}, std::string("up")};
        case SettingType::kOrientation:
            return {std::string("sideways"), std::vector<double>{0.0, 0.0, 0.0}, 1.0};
        case SettingType::kInteger: {
            const auto low = static_cast<std::int64_t>(info.range->min),
                       high = static_cast<std::int64_t>(info.range->max);
            std::vector<SettingValue> bad = {low - 1, 1.5, std::string("3"), true};
            if (high < std::numeric_limits<std::int64_t>::max() / 2) bad.emplace_back(high + 1);
            return bad;
        }
        case SettingType::kNumber: {
            const double low = info.range->min, high = info.range->max;
            return {info.range->min_excluded ? low : std::nextafter(low, -infinity), std::nextafter(high, infinity),
                    nan, infinity, std::string("2")};
        }
    }
    return {};
}

}  // namespace fretwork::testing
