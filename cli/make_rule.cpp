#include "cli/make_rule.h"

namespace fretwork::cli {
namespace {

std::string escaped(const std::string& path) {
    std::string out;
    for (const char c : path) {
        if (c == ' ' || c == '#' || c == ':' || c == '\\') out += '\\';
        if (c == '$') out += '$';
        out += c;
    }
    return out;
}

}  // namespace

std::string make_rule(const std::string& target, std::span<const std::string> inputs) {
    std::string rule = escaped(target).append(":");
    for (const std::string& input : inputs) rule.append(" \\\n  ").append(escaped(input));
    rule.append("\n");
    for (const std::string& input : inputs) rule.append("\n").append(escaped(input)).append(":\n");
    return rule;
}

}  // namespace fretwork::cli
