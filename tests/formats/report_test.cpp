// Parts of the report page: text, bytes, pictures, the packed mesh.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "formats/html_text.h"
#include "formats/jpeg_reader.h"
#include "formats/jpeg_writer.h"
#include "formats/report_chart.h"
#include "formats/report_mesh.h"
#include "formats/report_strength.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

TEST_CASE("html: text is escaped, broken text is replaced", "[formats][report]") {
    CHECK(html_escaped("a<b>&\"c'") == "a&lt;b&gt;&amp;&quot;c&#39;");
    CHECK(html_escaped("Gew\xC3\xBCrz \xE2\x82\xAC \xF0\x9F\x90\xB0") == "Gew\xC3\xBCrz \xE2\x82\xAC \xF0\x9F\x90\xB0");
    const std::string replaced = "\xEF\xBF\xBD";
    for (const char* broken : {"\xFF", "\xC0", "\x01", "\x7F"}) CHECK(html_escaped(broken) == replaced);
    CHECK(html_escaped("\xC3") == replaced);
    CHECK(html_escaped("\xED\xA0\x80") == replaced + replaced + replaced);
    CHECK(html_escaped("\xC0<") == replaced + "&lt;");
}

TEST_CASE("html: base64 as RFC 4648 has it", "[formats][report]") {
    const std::vector<std::pair<std::string, std::string>> vectors = {{"", ""},
                                                                      {"f", "Zg=="},
                                                                      {"fo", "Zm8="},
                                                                      {"foo", "Zm9v"},
                                                                      {"foob", "Zm9vYg=="},
                                                                      {"fooba", "Zm9vYmE="},
                                                                      {"foobar", "Zm9vYmFy"},
                                                                      {std::string("\xFB\xFF\0", 3), "+/8A"}};
    for (const auto& [bytes, text] : vectors) CHECK(base64(bytes) == text);
    CHECK(data_uri("image/png", "foo") == "data:image/png;base64,Zm9v");
}

TEST_CASE("jpeg: what is written is read again, nearly as it was", "[formats][report]") {
    Image image{32, 24, {}, false};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.pixels.push_back({static_cast<std::uint8_t>(8 * x), static_cast<std::uint8_t>(10 * y), 90, 255});
    const std::string bytes = write_jpeg(image, 92);
    CHECK(write_jpeg(image, 92) == bytes);
    CHECK(write_jpeg(image, 30).size() < bytes.size());
    const Image back = read_jpeg(bytes, "back.jpg", {});
    REQUIRE(back.width == 32);
    REQUIRE(back.height == 24);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) REQUIRE(std::abs(int{back.pixels[i][k]} - int{image.pixels[i][k]}) <= 12);
    image.pixels.pop_back();
    CHECK_THROWS_AS(write_jpeg(image), InvalidInput);
}

ReportMesh box_mesh() {
    ReportMesh mesh;
    mesh.mesh = testing::make_box(Vec3(1, 2, 3), Vec3(5, 4, 9));
    mesh.vertex_colors.assign(mesh.mesh.positions_mm.size(), {10, 20, 30});
    mesh.bridge.assign(mesh.mesh.triangles.size(), 1);
    mesh.stress_before = mesh.stress_after = mesh.bridge;
    return mesh;
}

TEST_CASE("report: the packed mesh holds every vertex, triangle and fact", "[formats][report]") {
    const ReportMesh mesh = box_mesh();
    const auto json = nlohmann::json::parse(report_mesh_json(mesh));
    CHECK(json["box"] == nlohmann::json::array({1, 2, 3, 5, 4, 9}));
    CHECK(json["wide"] == false);
    const auto length = [&](const char* key) { return json[key].get<std::string>().size(); };
    CHECK(length("positions") == 8 * 6 / 3 * 4);
    CHECK(length("tints") == 8 * 3 / 3 * 4);
    CHECK(length("triangles") == 12 * 6 / 3 * 4);
    CHECK(length("facts") == 12 * 3 / 3 * 4);
    CHECK(length("palette") == 256 * 3 / 3 * 4);
    ReportMesh wrong = mesh;
    wrong.bridge.pop_back();
    CHECK_THROWS_AS(report_mesh_json(wrong), InvalidInput);
    wrong = mesh;
    wrong.vertex_colors.pop_back();
    CHECK_THROWS_AS(report_mesh_json(wrong), InvalidInput);
}

TEST_CASE("report: tells whether it holds, load by load, place by place, round by round", "[formats][report]") {
    StrengthRecord strength;
    strength.rounds = {{0.75, 12, 34}, {1.5, 3, 0}};
    StrengthReport& report = strength.check.report;
    report.least_factor = 1.5;
    report.safety_factor = 2.0;
    report.voxels = 4321;
    report.cases.resize(2);
    report.cases[0].name = "push <up>";
    report.cases[1].name = "pinch";
    report.cases[1].least_factor = 7.25;
    report.weakest = {{Vec3(1, -2.25, 3), 1.5, 1e6, 2.5e6, 1}};
    strength.stopped_by = "no gain";
    const std::string html = strength_section(strength);
    for (const char* told : {"Not as asked.", "4321 voxels", "factor of safety of 1.5; asked is 2", "push &lt;up&gt;",
                             "<td class=\"number\">7.25</td>", "(1.0, -2.2, 3.0) mm",
                             "<td class=\"number\">2.5</td><td class=\"number\">pinch</td>",
                             ">as carved</th><td class=\"number\">0.75</td><td class=\"number\">12</td><td "
                             "class=\"number\">34</td>",
                             ">round 1</th>", "The rounds ended: no gain."}) {
        CAPTURE(told);
        CHECK(html.find(told) != std::string::npos);
    }
    CHECK(html.find("push <up>") == std::string::npos);
    report.least_factor = 2.0;
    CHECK(strength_section(strength).find("Yes.") != std::string::npos);
}

TEST_CASE("report: one scale for both patterns, three decades below a round number", "[formats][report]") {
    ShellStress stress;
    stress.before.samples_mpa = {0.1, 3.0, 13.0};
    stress.after.samples_mpa = {0.1, 2.0, 4.0};
    const StressScale scale = stress_scale(stress);
    CHECK(scale.high_mpa == Approx(20.0));
    CHECK(scale.low_mpa == Approx(0.02));
    CHECK(scale.place(0.0) == 0.0);
    CHECK(scale.place(0.02) == 0.0);
    CHECK(scale.place(20.0) == Approx(1.0));
    CHECK(scale.place(50.0) == 1.0);
    CHECK(scale.place(0.2) == Approx(1.0 / 3.0));
    CHECK(stress_scale({}).high_mpa == 1.0);
    const StressFigures figures = stress_figures(stress.before.samples_mpa);
    CHECK(figures.average_mpa == Approx(16.1 / 3.0));
    CHECK(figures.median_mpa == 3.0);
    CHECK(figures.p99_mpa == 13.0);
    CHECK(stress_figures({}).max_mpa == 0.0);
}

TEST_CASE("report: colours of stress grow lighter all the way", "[formats][report]") {
    double last = -1.0;
    for (int i = 0; i <= 32; ++i) {
        const Rgb8 c = stress_color(i / 32.0);
        const double luma = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        CHECK(luma > last);
        last = luma;
    }
    // The ends of the published table.
    CHECK(std::abs(int{stress_color(0.0)[0]} - 68) <= 4);
    CHECK(std::abs(int{stress_color(1.0)[1]} - 231) <= 4);
    CHECK(stress_color(-1.0) == stress_color(0.0));
}

TEST_CASE("report: charts bear empty and single runs", "[formats][report]") {
    CHECK(iteration_chart({}).empty());
    ReinforceRecord turn;
    CHECK(iteration_chart({turn}).find("nan") == std::string::npos);
    CHECK(stress_histogram({}, {}).find("nan") == std::string::npos);
}

}  // namespace
}  // namespace fretwork
