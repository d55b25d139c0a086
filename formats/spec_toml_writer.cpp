#include "formats/spec_toml_writer.h"

#include <algorithm>
#include <type_traits>

#include "formats/number_text.h"

namespace fretwork {
namespace {

std::string scalar_text(bool value) {
    return value ? "true" : "false";
}

std::string scalar_text(std::int64_t value) {
    return std::to_string(value);
}

std::string scalar_text(double value) {
    std::string text;
    append_number(text, value);
    // TOML tells a fraction from an integer by its point or exponent.
    if (text.find_first_of(".e") == text.npos) text += ".0";
    return text;
}

std::string scalar_text(std::string_view value) {
    constexpr std::string_view kHex = "0123456789ABCDEF";
    std::string text = "\"";
    for (const char c : value) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            text += '\\';
            text += c;
        } else if (c == '\n') {
            text += "\\n";
        } else if (byte < 0x20 || byte == 0x7f) {
            text += "\\u00";
            text += kHex[byte >> 4];
            text += kHex[byte & 15];
        } else {
            text += c;
        }
    }
    return text + '"';
}

bool is_bare(std::string_view key) {
    return !key.empty() && std::ranges::all_of(key, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

/// Dotted path with every part quoted that needs it.
std::string key_text(std::string_view path) {
    std::string text;
    while (true) {
        const std::size_t dot = path.find('.');
        const std::string_view part = path.substr(0, dot);
        text += is_bare(part) ? std::string(part) : scalar_text(part);
        if (dot == path.npos) return text;
        text += '.';
        path.remove_prefix(dot + 1);
    }
}

/// "shell.thickness_mm" -> "shell"; empty for a key of the root.
std::string_view table_of(std::string_view key) {
    const std::size_t dot = key.rfind('.');
    return dot == key.npos ? std::string_view{} : key.substr(0, dot);
}

std::string value_text(const SettingValue& value) {
    return std::visit(
        [](const auto& held) -> std::string {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::vector<double>>) {
                std::string text = "[";
                for (std::size_t i = 0; i < held.size(); ++i) text += (i > 0 ? ", " : "") + scalar_text(held[i]);
                return text + "]";
            } else {
                return scalar_text(held);
            }
        },
        value);
}

void append_assignment(std::string& out, std::string_view key, const SettingValue& value) {
    out.append(key_text(key)).append(" = ").append(value_text(value)).append("\n");
}

}  // namespace

std::string write_spec_toml(const SpecDocument& document) {
    std::string out;
    std::vector<std::string_view> order;
    for (const SettingAssignment& entry : document.assignments) {
        const std::string_view table = table_of(entry.key);
        if (table.empty()) append_assignment(out, entry.key, entry.value);
        if (!table.empty() && std::ranges::find(order, table) == order.end()) order.push_back(table);
    }
    for (const std::string_view table : order) {
        out.append(out.empty() ? "[" : "\n[").append(key_text(table)).append("]\n");
        for (const SettingAssignment& entry : document.assignments)
            if (table_of(entry.key) == table)
                append_assignment(out, std::string_view(entry.key).substr(table.size() + 1), entry.value);
    }
    for (const SettingTable& table : document.tables) {
        out.append(out.empty() ? "[[" : "\n[[").append(key_text(table.array)).append("]]\n");
        for (const SettingAssignment& entry : table.entries) append_assignment(out, entry.key, entry.value);
    }
    return out;
}

}  // namespace fretwork
