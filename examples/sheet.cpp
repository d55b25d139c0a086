// Puts pictures side by side; examples/gallery.py uses it.
//   sheet OUT.png COLUMNS PICTURE...
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <vector>

#include "core/render/contact_sheet.h"
#include "formats/atomic_write.h"
#include "formats/image_file.h"
#include "formats/png_writer.h"

int main(int count, char** arguments) {
    if (count < 4) {
        std::fprintf(stderr, "usage: sheet OUT.png COLUMNS PICTURE...\n");
        return 1;
    }
    try {
        std::vector<fretwork::Image> pictures;
        for (int i = 3; i < count; ++i) pictures.push_back(fretwork::read_image(std::filesystem::path(arguments[i])));
        const fretwork::Image sheet = fretwork::contact_sheet(pictures, std::atoi(arguments[2]), 6);
        fretwork::atomic_write(arguments[1], fretwork::write_png(sheet));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "sheet: %s\n", error.what());
        return 2;
    }
}
