#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "child_process.h"
#include "core/base/error.h"
#include "markdown.h"
#include "svg_plot.h"

namespace fretwork::bench {
namespace {

TEST_CASE("markdown: a table has a line per row", "[bench]") {
    MarkdownTable table({"a", "b"});
    table.add({"1", "x | y"});
    CHECK(table.text() == "| a | b |\n|---|---|\n| 1 | x | y |\n");
}

TEST_CASE("markdown: a section is replaced and nothing else", "[bench]") {
    const std::string document = "# T\n<!-- one: begin -->\nold\n<!-- one: end -->\nrest\n";
    CHECK(with_section(document, "one", "new\n") == "# T\n<!-- one: begin -->\nnew\n<!-- one: end -->\nrest\n");
    CHECK(with_section(with_section(document, "one", "new\n"), "one", "old\n") == document);
    CHECK_THROWS_AS(with_section(document, "two", ""), InvalidInput);
    CHECK_THROWS_AS(with_section("<!-- one: end -->\n<!-- one: begin -->\n", "one", ""), InvalidInput);
}

TEST_CASE("fitted exponent: finds the power of a power law, whatever its factor", "[bench]") {
    for (const double power : {0.0, 1.0, 1.5, -2.0}) {
        std::vector<Vec2> points;
        for (const double x : {10.0, 300.0, 4000.0}) points.emplace_back(x, 7.0 * std::pow(x, power));
        CHECK(fitted_exponent(points) == Approx(power).margin(1e-12));
    }
    // Logarithms (0, 0), (1, 0), (2, 1): the slope by hand is (1/3 + 2/3) / 2.
    CHECK(fitted_exponent({{1, 1}, {std::exp(1.0), 1}, {std::exp(2.0), std::exp(1.0)}}) == Approx(0.5));
    CHECK_THROWS_AS(fitted_exponent({{1, 1}, {0, 3}}), InvalidInput);
}

TEST_CASE("plot: linear growth runs along the dashed line, and every series has its name", "[bench]") {
    // Both axes span two decades of equal length in values; points on the diagonal of the frame.
    const std::string svg =
        log_log_plot({"T", "x", "y"}, {{"first", {{1, 1}, {10, 10}, {100, 100}}}, {"second", {{1, 100}}}});
    CHECK(svg.find("<polyline points=\"70.0,425.0 340.0,232.5 610.0,40.0 \"") != std::string::npos);
    CHECK(svg.find("<line x1=\"70.0\" y1=\"425.0\" x2=\"610.0\" y2=\"40.0\" stroke=\"#999\"") != std::string::npos);
    CHECK(svg.find(">first</text>") != std::string::npos);
    CHECK(svg.find(">second</text>") != std::string::npos);
    CHECK_THROWS_AS(log_log_plot({}, {{"none", {{0, 1}}}}), InvalidInput);
}

TEST_CASE("child process: passes on what was made, how it ended and what it took", "[bench]") {
    constexpr std::size_t bytes = std::size_t{96} << 20;
    const ChildResult small = run_in_child([] { return std::string(100000, 'x'); });
    CHECK(small.output == std::string(100000, 'x'));
    CHECK(small.exit_code == 0);
    // From a place that is only known at run time, or a compiler would do without the memory.
    const std::size_t place = bytes - small.output.size();
    const ChildResult large = run_in_child([=] {
        const std::vector<char> all(bytes, 'y');
        const volatile char* one = all.data() + place;
        return std::string(1, *one);
    });
    CHECK(large.output == "y");
    CHECK(large.peak_bytes >= small.peak_bytes + bytes / 2);
    CHECK(run_in_child([]() -> std::string { throw InvalidInput("expected here"); }).exit_code == 1);
    CHECK(run_command({"/bin/sh", "-c", "exit 3"}).exit_code == 3);
    CHECK(run_command({"/bin/sh", "-c", "kill -9 $$"}).exit_code == 137);
    CHECK_THROWS_AS(run_command({"/nowhere/at/all"}), FileError);
}

}  // namespace
}  // namespace fretwork::bench
