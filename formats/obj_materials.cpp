#include "formats/obj_materials.h"

#include <set>

#include "formats/color_channel.h"
#include "formats/number_text.h"
#include "formats/text_scanner.h"

namespace fretwork {

std::string obj_material_name(const Rgb8& color) {
    std::string name = hex_color(color);
    name[0] = 'c';
    return name;
}

std::string write_obj_materials(std::span<const Rgb8> triangle_colors) {
    std::string out = "# Fretwork\n";
    std::set<Rgb8> seen;
    for (const Rgb8& color : triangle_colors) {
        if (!seen.insert(color).second) continue;
        out += "newmtl " + obj_material_name(color) + "\nKd";
        for (const std::uint8_t channel : color) {
            out += ' ';
            append_number(out, static_cast<float>(channel) / 255.0F);
        }
        out += '\n';
    }
    return out;
}

std::map<std::string, Rgb8, std::less<>> read_obj_materials(std::string_view bytes, std::string_view source) {
    std::map<std::string, Rgb8, std::less<>> materials;
    Rgb8* open = nullptr;
    TextScanner scanner(bytes, source, {.comment = '#', .backslash_continues = true});
    for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word()) {
        if (word == "newmtl") {
            const std::string_view name = scanner.word_in_line();
            if (name.empty()) scanner.fail({}, "the name of a material");
            open = &(materials[std::string(name)] = kUncolored);
        } else if (word == "Kd" && open != nullptr) {
            // Spectral curves (Kd spectral) and CIE colours (Kd xyz) are rare and left out.
            const std::string_view first = scanner.word_in_line();
            if (first != "spectral" && first != "xyz") {
                std::array<double, 3> value{};
                value.fill(scanner.to_number(first, "a colour from 0 to 1"));
                for (std::size_t k = 1; k < 3; ++k) {
                    const std::string_view next = scanner.word_in_line();
                    if (next.empty()) break;  // One number stands for all three.
                    value[k] = scanner.to_number(next, "a colour from 0 to 1");
                }
                *open = {color_from_unit(value[0]), color_from_unit(value[1]), color_from_unit(value[2])};
            }
        }
        scanner.next_line();
    }
    return materials;
}

}  // namespace fretwork
