// Large meshes go past the XML reader; what they are read as must not tell.
#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "formats/png_writer.h"
#include "formats/threemf_model_reader.h"
#include "formats/threemf_names.h"
#include "formats/threemf_reader.h"
#include "formats/xml_reader.h"
#include "formats/zip_reader.h"
#include "support/make_packages.h"

namespace fretwork {
namespace {

using testing::make_model;
using testing::make_package;
using testing::make_tetrahedron;
using testing::make_zip;
using threemf::Model;
using threemf::read_model;

/// How elements may be written that mean the same.
enum class Spelling {
    kPlain,
    kPrefix,
    kSingleQuotes,
    kBlanks,
    kOtherOrder,
    kMoreAttributes,
    kEndTag,
    kEntities,
    kPlus,
    kComments,
    kMixed
};
constexpr int kSpellings = 11;

using Attributes = std::vector<std::pair<std::string, std::string>>;

std::string element(const std::string& name, Attributes attributes, Spelling spelling) {
    const std::string tag = (spelling == Spelling::kPrefix ? "c:" : "") + name;
    const char quote = spelling == Spelling::kSingleQuotes ? '\'' : '"';
    if (spelling == Spelling::kOtherOrder) std::swap(attributes.front(), attributes.back());
    if (spelling == Spelling::kMoreAttributes) attributes.insert(attributes.begin() + 1, {"fw:x", "<>"});
    std::string xml = "<";
    xml += tag;
    for (auto& [key, value] : attributes) {
        if (spelling == Spelling::kEntities) value.replace(0, 1, "&#" + std::to_string(value[0]) + ";");
        if (spelling == Spelling::kPlus && value[0] != '-') value.insert(0, 1, '+');
        if (spelling == Spelling::kMoreAttributes && key == "fw:x") value = "&lt;>";
        xml += (spelling == Spelling::kBlanks ? "\n \t" : " ") + key + (spelling == Spelling::kBlanks ? " = " : "=") +
               quote + value + quote;
    }
    if (spelling == Spelling::kComments) return xml + "/><!-- <vertex x=\"9\" y=\"9\" z=\"9\"/> -->\r\n";
    return xml + (spelling == Spelling::kEndTag ? "></" + tag + ">\n" : " />\n");
}

struct Sample {
    std::vector<std::array<std::string, 3>> vertices;
    std::vector<Triangle> triangles;
    std::vector<std::array<int, 4>> properties;  ///< group and colours; group 0 for none

    explicit Sample(std::uint32_t seed) {
        std::mt19937 random(seed);
        const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
        static constexpr std::array<const char*, 6> kOdd = {"0", "-0.0", "1e-400", "12345678.9", "1e9", "-2.5E-3"};
        for (int v = 0; v < 40; ++v) {
            auto& vertex = vertices.emplace_back();
            for (std::string& number : vertex)
                number = below(4) == 0 ? kOdd[below(kOdd.size())] : std::to_string(below(100000) / 64.0 - 500.0);
        }
        for (int t = 0; t < 60; ++t) {
            // Now and then one corner twice.
            triangles.push_back({below(40), below(40), below(40)});
            properties.push_back({below(5) == 0 ? 0 : static_cast<int>(below(2) + 8), static_cast<int>(below(3)),
                                  static_cast<int>(below(3)), static_cast<int>(below(3))});
        }
    }

    [[nodiscard]] std::string model(Spelling spelling) const {
        std::mt19937 random(7);
        const auto one = [&] {
            if (spelling != Spelling::kMixed) return spelling;
            // All but the prefix, which is for a whole mesh to have.
            const auto any = static_cast<Spelling>(random() % kSpellings);
            return any == Spelling::kPrefix || any == Spelling::kMixed ? Spelling::kPlain : any;
        };
        const std::string c = spelling == Spelling::kPrefix ? "c:" : "";
        static constexpr std::array kCorners = {"v1", "v2", "v3"}, kProperties = {"p1", "p2", "p3"};
        std::string mesh = "<" + c + "vertices>";
        for (const auto& [x, y, z] : vertices) mesh += element("vertex", {{"x", x}, {"y", y}, {"z", z}}, one());
        mesh += "</" + c + "vertices>\n<" + c + "triangles>";
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            Attributes all;
            for (std::size_t k = 0; k < 3; ++k) all.emplace_back(kCorners[k], std::to_string(triangles[t][k]));
            if (properties[t][0] != 0) all.emplace_back("pid", std::to_string(properties[t][0]));
            // One index or three; without a group that of the object counts.
            const std::size_t count = t % 2 == 0 ? 1 : 3;
            for (std::size_t k = 0; k < count; ++k)
                all.emplace_back(kProperties[k], std::to_string(properties[t][k + 1]));
            mesh += element("triangle", all, one());
        }
        mesh += "</" + c + "triangles>";
        const std::string colors =
            "<m:color color=\"#102030\"/><m:color color=\"#FF0000\"/><m:color color=\"#00FF80\"/></m:colorgroup>";
        return make_model("<m:colorgroup id=\"8\">" + colors + "<m:colorgroup id=\"9\"><m:color color=\"#FFFFFF\"/>" +
                              colors + "<object id=\"1\" pid=\"9\" pindex=\"3\"><mesh>" + mesh + "</mesh></object>" +
                              make_tetrahedron(2, "", "pid=\"8\" p1=\"1\""),
                          "<item objectid=\"1\"/>", "xmlns:c=\"" + std::string(threemf::kCore) + "\"");
    }
};

void check_same(const Model& a, const Model& b) {
    for (const threemf::ResourceId id : {1u, 2u}) {
        const threemf::Object &one = a.objects.at(id), &other = b.objects.at(id);
        CHECK(one.mesh.positions_mm == other.mesh.positions_mm);
        CHECK(one.mesh.triangles == other.mesh.triangles);
        CHECK(one.triangle_colors == other.triangle_colors);
    }
    CHECK(a.warnings == b.warnings);
}

TEST_CASE("3mf elements: a mesh is the same however its elements are written", "[formats][threemf][property]") {
    const auto seed = GENERATE(range(1u, 5u));
    const Sample sample(seed);
    const Model plain = read_model(sample.model(Spelling::kPlain), "m");
    // By hand: what the attributes say.
    const threemf::Object& object = plain.objects.at(1);
    REQUIRE(object.mesh.positions_mm.size() == sample.vertices.size());
    for (std::size_t v = 0; v < sample.vertices.size(); ++v)
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(object.mesh.positions_mm[v][static_cast<int>(k)] ==
                  std::strtod(sample.vertices[v][k].c_str(), nullptr));
    std::vector<Triangle> kept;
    for (const Triangle& t : sample.triangles)
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) kept.push_back(t);
    CHECK(object.mesh.triangles == kept);
    CHECK(object.triangle_colors.size() == kept.size());
    CHECK(plain.objects.at(2).triangle_colors == std::vector<Rgb8>(4, Rgb8{255, 0, 0}));
    for (int spelling = 1; spelling < kSpellings; ++spelling) {
        CAPTURE(seed, spelling);
        check_same(read_model(sample.model(static_cast<Spelling>(spelling)), "m"), plain);
    }
}

TEST_CASE("3mf elements: blocks of any size give the same", "[formats][threemf][property]") {
    const auto spelling = GENERATE(Spelling::kPlain, Spelling::kMixed);
    const RunControl run;
    const std::string xml = Sample(3).model(spelling);
    const Model whole = read_model(xml, "m");
    for (const std::size_t size : {1, 2, 3, 7, 50, 100, 1000}) {
        CAPTURE(size);
        threemf::ModelReader reader("m", {}, run);
        for (std::size_t at = 0; at < xml.size(); at += size) reader.feed(std::string_view(xml).substr(at, size));
        check_same(reader.finish(), whole);
    }
}

TEST_CASE("3mf elements: a text ends where its root does", "[formats][threemf][errors]") {
    const std::string xml = make_model(make_tetrahedron(1), "");
    CHECK(read_model(xml + " \n<!-- end -->\n ", "m").objects.size() == 1);
    CHECK_THROWS_WITH(read_model(xml + "more", "m"), Catch::Contains("well-formed"));
    CHECK_THROWS_WITH(read_model(xml.substr(0, xml.size() - 3), "m"), Catch::Contains("well-formed"));
}

TEST_CASE("3mf elements: bytes of two to a character are read as well", "[formats][threemf]") {
    const std::string xml = Sample(2).model(Spelling::kPlain);
    std::string utf16 = "\xFE\xFF";
    for (const char c : xml.substr(xml.find('\n') + 1)) utf16 += {'\0', c};
    check_same(read_model(utf16, "m"), read_model(xml, "m"));
}

TEST_CASE("3mf elements: those of another namespace are none of ours", "[formats][threemf]") {
    const std::string corners = "x=\"1\" y=\"2\" z=\"3\"/>";
    // The first vertices stand where the namespace without a prefix is another one; one has a namespace of its own.
    const std::string xml = "<c:model xmlns:c=\"" + std::string(threemf::kCore) +
                            "\" xmlns=\"urn:other\"><c:resources><c:object id=\"1\"><c:mesh><c:vertices><vertex " +
                            corners + "<c:vertex " + corners + "<vertex " + corners +
                            "</c:vertices></c:mesh></c:object><object xmlns=\"" + std::string(threemf::kCore) +
                            "\" id=\"2\"><mesh><vertices><vertex " + corners + "<vertex xmlns=\"urn:other\" " +
                            corners + "<vertex " + corners +
                            "</vertices></mesh></object></c:resources><c:build/></c:model>";
    const RunControl run;
    for (const std::size_t size : {xml.size(), std::size_t{1}}) {
        threemf::ModelReader reader("m", {}, run);
        for (std::size_t at = 0; at < xml.size(); at += size) reader.feed(std::string_view(xml).substr(at, size));
        const Model model = reader.finish();
        CHECK(model.objects.at(1).mesh.positions_mm.size() == 1);
        CHECK(model.objects.at(2).mesh.positions_mm.size() == 2);
    }
}

TEST_CASE("xml: the reader tells when elements may be kept from it", "[formats]") {
    struct Deaf : XmlHandler {
        void start(const XmlElement&) override {}
        void end() override {}
        void text(std::string_view) override {}
    };
    const auto told_after = [](std::string_view xml) {
        Deaf handler;
        XmlReader reader(handler, "m");
        reader.feed(xml);
        return reader.at_content();
    };
    CHECK(told_after("<a><b>"));
    CHECK(told_after("<?xml version=\"1.0\" encoding=\"UTF-8\"?><a><b/>"));
    CHECK(told_after("<a><b c=\"&lt;\"/><!-- d -->"));
    CHECK_FALSE(told_after(""));
    CHECK_FALSE(told_after("<a"));
    CHECK_FALSE(told_after("<a><b c=\"d"));
    CHECK_FALSE(told_after("<a><b c=\">"));
    CHECK_FALSE(told_after("<a><!-- <b>"));
    CHECK_FALSE(told_after("<a><![CDATA[<b>"));
    CHECK_FALSE(told_after("<a><?b <c>"));
    CHECK_FALSE(told_after("<a></a>"));
    CHECK_FALSE(told_after("<?xml version=\"1.0\" encoding=\"ISO-2022-JP\"?><a><b>"));
    CHECK_FALSE(told_after(std::string_view("\xFF\xFE<\0a\0>\0", 8)));
}

/// What is thrown, without the name that tells the spelling.
std::string refusal_of(const std::string& resources, const std::string& attributes = "") {
    try {
        read_model(make_model(resources, "", attributes), "m");
    } catch (const InvalidInput& refused) {
        return refused.what();
    }
    return "nothing";
}

TEST_CASE("3mf elements: mistakes are named with their line, as the XML reader names them",
          "[formats][threemf][errors]") {
    const std::string good = "<%vertex x=\"0\" y=\"0\" z=\"0\"/>\n";
    const std::string fine = "<%triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"8\" p1=\"0\"/>\n";
    struct Mistake {
        std::string vertex, triangle;
        std::string found;
    };
    const std::vector<Mistake> mistakes = {
        {"<%vertex x=\"nan\" y=\"0\" z=\"0\"/>", fine, "x \"nan\""},
        {"<%vertex x=\"0\" y=\"1e400\" z=\"0\"/>", fine, "y \"1e400\""},
        {"<%vertex x=\"0\" y=\"1.5e9\" z=\"0\"/>", fine, "y \"1.5e9\""},
        {"<%vertex x=\"0\" y=\"0\" z=\"-inf\"/>", fine, "z \"-inf\""},
        {"<%vertex x=\"0x10\" y=\"0\" z=\"0\"/>", fine, "x \"0x10\""},
        {"<%vertex x=\"\" y=\"0\" z=\"0\"/>", fine, "x \"\""},
        {"<%vertex x=\"0\" y=\"0\"/>", fine, "without z"},
        {"<%vertex x=\"0\" x=\"0\" y=\"0\" z=\"0\"/>", fine, "redefined"},
        {"<%vertex x=\"0\" y=\"0\" z=\"0\"/></%none>", fine, "well-formed"},
        {"<%vertex x=\"0\" y=\"0\" z=\"<\"/>", fine, "well-formed"},
        {"<%vertex x=0 y=\"0\" z=\"0\"/>", fine, "well-formed"},
        {"<%vertex x=\"0\" y=\"0\" z=\"&x;\"/>", fine, "well-formed"},
        {"<%vertexx=\"0\" y=\"0\" z=\"0\"/>", fine, "well-formed"},
        {good, "<%triangle v1=\"0\" v2=\"-1\" v3=\"2\"/>", "v2 \"-1\""},
        {good, "<%triangle v1=\"0\" v2=\"1\" v3=\"4294967297\"/>", "v3 \"4294967297\""},
        {good, "<%triangle v1=\"0\" v2=\"1\" v3=\"4294967295\"/>", "v3 \"4294967295\""},
        {good, "<%triangle v1=\"0\" v2=\"1\" v3=\"18446744073709551617\"/>", "v3 \"18446744073709551617\""},
        {good, "<%triangle v1=\"0\" v2=\"1\" v3=\"1.5\"/>", "v3 \"1.5\""},
        {good, "<%triangle v1=\"0\" v2=\"1\"/>", "without v3"},
        {good, "<%triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"0\" p1=\"0\"/>", "pid \"0\""},
        {good, "<%triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"2147483648\" p1=\"0\"/>", "pid \"2147483648\""},
        {good, "<%triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"8\" p1=\"1\"/>", "colour index 1"},
        {good, "<%triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"8\" p1=\"-1\"/>", "p1 \"-1\""},
    };
    for (const Mistake& mistake : mistakes) {
        CAPTURE(mistake.vertex, mistake.triangle);
        const auto mesh = [&](const std::string& prefix) {
            std::string xml =
                "<m:colorgroup id=\"8\"><m:color color=\"#102030\"/></m:colorgroup><object id=\"1\"><mesh>";
            xml += "<%vertices>\n" + good + good + good + mistake.vertex + "\n" + good + "</%vertices><%triangles>\n" +
                   fine + fine + mistake.triangle + "\n</%triangles></mesh></object>";
            for (std::size_t at = xml.find('%'); at != xml.npos; at = xml.find('%', at)) xml.replace(at, 1, prefix);
            return xml;
        };
        const std::string space = "xmlns:c=\"" + std::string(threemf::kCore) + "\"";
        const std::string said = refusal_of(mesh(""), space);
        CHECK_THAT(said, Catch::Contains(mistake.found));
        // <vertices> stands in line 4, and a line is left empty behind the fourth vertex where it is a good one.
        CHECK_THAT(said, Catch::Contains(mistake.vertex != good ? "line 8:" : "line 14:"));
        // The prefix sends all of it through the XML reader.
        std::string through = refusal_of(mesh("c:"), space);
        for (std::size_t at = through.find("c:"); at != through.npos; at = through.find("c:", at)) through.erase(at, 2);
        CHECK(said == through);
    }
}

TEST_CASE("3mf: parts of many blocks arrive whole, whatever else is read meanwhile",
          "[formats][threemf][determinism]") {
    Image picture;
    picture.width = picture.height = 1;
    picture.pixels = {{10, 20, 30, 255}};
    // A mesh of several blocks, whose texture is asked for while they are unpacked.
    std::string mesh = "<object id=\"1\"><mesh><vertices>";
    for (int v = 0; v < 20000; ++v)
        mesh += "<vertex x=\"" + std::to_string(v * 0.37) + "\" y=\"" + std::to_string(v % 71) + "\" z=\"1\"/>\n";
    mesh += "</vertices><triangles>";
    for (int v = 2; v < 20000; ++v)
        mesh += "<triangle v1=\"" + std::to_string(v) + "\" v2=\"" + std::to_string(v - 1) + "\" v3=\"" +
                std::to_string(v - 2) + "\" pid=\"6\" p1=\"0\"/>\n";
    const std::string xml = make_model(
        "<m:texture2d id=\"5\" path=\"/t.png\" contenttype=\"image/png\"/><m:texture2dgroup id=\"6\" texid=\"5\">"
        "<m:tex2coord u=\"0\" v=\"0\"/></m:texture2dgroup>" +
            mesh + "</triangles></mesh></object>",
        "<item objectid=\"1\"/>");
    REQUIRE(xml.size() > (5u << 18));
    const std::string bytes = make_package(xml, {{"t.png", write_png(picture)}});
    for (const int threads : {1, 4}) {
        const ThreadLimit limit(threads);
        std::string joined;
        ZipReader(bytes, "p").read_blocks("3D/3dmodel.model", [&](std::string_view block) { joined += block; });
        CHECK((joined == xml));
        const MeshFile file = read_threemf(bytes, "p");
        CHECK(file.mesh.positions_mm.size() == 20000);
        CHECK(file.mesh.positions_mm[19999].x() == Approx(19999 * 0.37));
        CHECK(file.triangle_colors == std::vector<Rgb8>(19998, Rgb8{10, 20, 30}));
    }
}

TEST_CASE("3mf: what is wrong first is told first", "[formats][threemf][errors]") {
    // Broken XML in the first of many blocks; the last ones cannot be unpacked.
    std::string text = "<model><resources></model>";
    std::mt19937 random(1);
    while (text.size() < (3u << 20)) text += std::to_string(random());
    std::string bytes = make_package(text);
    const std::size_t end = bytes.find("PK\x01\x02");
    for (std::size_t at = end - 5000; at < end - 4000; ++at) bytes[at] = static_cast<char>(bytes[at] ^ 0x5A);
    for (const int threads : {1, 4}) {
        const ThreadLimit limit(threads);
        CHECK_THROWS_WITH(read_threemf(bytes, "p"), Catch::Contains("line 1"));
        CHECK_THROWS_WITH(ZipReader(bytes, "p").read("3D/3dmodel.model", 1 << 26), Catch::Contains("entry"));
    }
}

}  // namespace
}  // namespace fretwork
