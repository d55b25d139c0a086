// The page of `carve --report`: what it holds, that it repeats, and how a real browser shows it.
#include <sys/wait.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork::testing {
namespace {

const std::vector<std::string> kQuick = {"--preset",     "draft",
                                         "--resolution", "32",
                                         "--width-mm",   "48",
                                         "-D",           "structure.max_iterations=3",
                                         "-D",           "structure.samples=100"};

ProgramResult carve(std::vector<std::string> line, const std::vector<std::string>& more = {}) {
    line.insert(line.begin(), "carve");
    line.insert(line.end(), kQuick.begin(), kQuick.end());
    line.insert(line.end(), more.begin(), more.end());
    return run_program(line);
}

std::string vase_off() {
    const TriangleMesh vase = make_vase(50.0, 32, 16);
    return write_mesh({vase}, MeshFormat::kOff);
}

std::size_t count(const std::string& text, const std::string& word) {
    std::size_t n = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++n;
    return n;
}

/// The page without the section that may differ between runs.
std::string without_times(std::string page) {
    const auto from = page.find("<section class=\"times\">");
    REQUIRE(from != std::string::npos);
    const auto to = page.find("</section>", from);
    return page.erase(from, to - from);
}

/// The page of a vase, with what else the line says.
std::string vase_page(const TemporaryFolder& folder, const std::vector<std::string>& more = {}) {
    spit(folder / "vase.off", vase_off());
    const ProgramResult result = carve(
        {folder / "vase.off", "--pattern", "cells", "-o", folder / "vase.3mf", "--report", folder / "vase.html"}, more);
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    return slurp(folder / "vase.html");
}

TEST_CASE("report: one page with every section, and nothing that points elsewhere", "[cli][report]") {
    const TemporaryFolder folder;
    const std::string page = vase_page(folder);
    for (const char* section : {">From example to object<", ">Stress<", ">Reinforcement, turn by turn<", ">Widths<",
                                ">Printability<", ">Mesh<", ">Settings<", ">Time<"})
        CHECK(count(page, section) == 1);
    CHECK(count(page, "<img ") == 6);
    CHECK(count(page, " alt=\"") == 6);
    CHECK(count(page, "<img src=\"data:image/") == 6);
    CHECK(count(page, "alt=\"\"") == 0);
    CHECK(count(page, "<canvas ") == 1);
    CHECK(count(page, "99th percentile") == 1);
    CHECK(count(page, "http://") + count(page, "https://") + count(page, "url(") + count(page, "@import") == 0);
    CHECK(page.find("<meta name=\"viewport\"") != std::string::npos);
    CHECK(page.find("prefers-color-scheme") != std::string::npos);
    CHECK(page.size() > 50'000);
    CHECK(page.size() < 2'000'000);
}

TEST_CASE("report: the same run gives the same page but for times, and the same carved file as without",
          "[cli][report][determinism]") {
    const TemporaryFolder folder;
    const std::string first = without_times(vase_page(folder, {"--threads", "1"}));
    const std::string carved = slurp(folder / "vase.3mf");
    CHECK(without_times(vase_page(folder, {"--threads", "2"})) == first);
    CHECK(slurp(folder / "vase.3mf") == carved);
    CHECK(without_times(vase_page(folder, {"--seed", "9"})) != first);
    REQUIRE(carve({folder / "vase.off", "--pattern", "cells", "-o", folder / "plain.3mf"}).exit_code == 0);
    CHECK(slurp(folder / "plain.3mf") == carved);
}

TEST_CASE("report: names are text, whatever they hold", "[cli][report]") {
    const TemporaryFolder folder;
    const std::string name = "a <b>&\"' .off";
    spit(folder / name, vase_off());
    REQUIRE(carve({folder / name, "--pattern", "cells", "-o", folder / "out.3mf", "--report", folder / "out.html"})
                .exit_code == 0);
    const std::string page = slurp(folder / "out.html");
    CHECK(page.find("a &lt;b&gt;&amp;&quot;&#39; .off") != std::string::npos);
    CHECK(page.find("a <b>") == std::string::npos);
}

TEST_CASE("report: without reinforcement and for each object of a 3MF", "[cli][report]") {
    const TemporaryFolder folder;
    const std::string off = vase_page(folder, {"-D", "structure.max_iterations=1", "-D", "structure.material_budget=0",
                                               "-D", "structure.geodesic_factor=0"});
    CHECK(count(off, "<img ") == 6);

    spit(folder / "two.3mf",
         make_package(make_model(make_mesh_object(1, make_vase(60.0, 32, 16), "name=\"one\"") +
                                     make_mesh_object(2, make_vase(50.0, 32, 16), "name=\"&lt;two&gt;\""),
                                 "<item objectid=\"1\"/><item objectid=\"2\"/>")));
    const ProgramResult result = carve(
        {folder / "two.3mf", "--pattern", "cells", "-o", folder / "two_out.3mf", "--report", folder / "two.html"});
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    const std::string page = slurp(folder / "two.html");
    CHECK(count(page, "<canvas ") == 2);
    CHECK(count(page, "<h2 class=\"object\">") == 2);
    CHECK(page.find("&lt;two&gt;") != std::string::npos);
}

bool installed(const char* program) {
    return std::system((std::string("command -v ") + program + " > /dev/null").c_str()) == 0;
}

/// The document as a real browser has it once its scripts have run; what it had to say goes to `log`.
std::string shown_by_browser(const TemporaryFolder& folder, const std::string& page, int width) {
    const std::string line =
        "timeout 120 chromium --headless --no-sandbox --disable-quic --no-first-run --disable-background-networking "
        "--disable-component-update --disable-sync --use-angle=swiftshader --enable-unsafe-swiftshader "
        "--enable-logging=stderr --virtual-time-budget=8000 --user-data-dir='" +
        (folder / ("profile" + std::to_string(width))) + "' --window-size=" + std::to_string(width) +
        ",900 --dump-dom 'file://" + page + "' > '" + (folder / "dom") + "' 2> '" + (folder / "log") + "'";
    const int status = std::system(line.c_str());
    REQUIRE(WIFEXITED(status));
    const std::string log = slurp(folder / "log");
    CAPTURE(log);
    REQUIRE(WEXITSTATUS(status) == 0);
    return slurp(folder / "dom");
}

/// The value of an attribute, as a number.
double attribute(const std::string& dom, const std::string& name) {
    const auto at = dom.find(name + "=\"");
    CAPTURE(name);
    REQUIRE(at != std::string::npos);
    return std::stod(dom.substr(at + name.size() + 2));
}

/// Tells of errors, of requests and of widths, in attributes of the document. The page stands in a frame of the width
/// asked for, because a browser's window may not be as narrow as a telephone.
std::string watched(const std::string& page, int width) {
    std::string inner = page;
    inner.insert(inner.find("<meta charset"),
                 "<script>window.errors=0;addEventListener('error',()=>++errors,true);"
                 "addEventListener('securitypolicyviolation',()=>++errors);</script>\n");
    std::string quoted;
    for (const char c : inner) quoted += c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
    return "<!DOCTYPE html><body><iframe width=\"" + std::to_string(width) + "\" height=\"800\" srcdoc=\"" + quoted +
           "\"></iframe><script>const f=document.querySelector('iframe');f.onload=()=>setTimeout(()=>{const "
           "w=f.contentWindow,d=w.document,r=document.documentElement;"
           "r.setAttribute('data-errors',w.errors);r.setAttribute('data-inner',w.innerWidth);"
           "r.setAttribute('data-scroll',d.documentElement.scrollWidth);"
           "r.setAttribute('data-client',d.documentElement.clientWidth);"
           "r.setAttribute('data-requests',w.performance.getEntriesByType('resource').filter(e=>!e.name.startsWith("
           "'data:')).length);"
           "r.setAttribute('data-view',d.querySelector('canvas').dataset.filled||'-1');"
           "r.setAttribute('data-pictures',[...d.images].filter(i=>i.complete&&i.naturalWidth>0).length);"
           "const b=[...d.querySelectorAll('button[data-show]')];b.forEach(x=>x.click());"
           "r.setAttribute('data-pressed',b.filter(x=>x.getAttribute('aria-pressed')==='true').length);"
           "f.remove();},500);</script></body>";
}

TEST_CASE("report: a browser shows it at the width of a desk and of a telephone, and draws the model",
          "[cli][report][browser]") {
    if (!installed("chromium")) {
        WARN("chromium is not installed: skipped");
        return;
    }
    const TemporaryFolder folder;
    const std::string page = vase_page(folder);
    for (const int width : {1200, 390}) {
        CAPTURE(width);
        spit(folder / "watched.html", watched(page, width));
        const std::string dom = shown_by_browser(folder, folder / "watched.html", 1280);
        CHECK(attribute(dom, "data-errors") == 0);
        CHECK(attribute(dom, "data-inner") == width);
        CHECK(attribute(dom, "data-scroll") <= attribute(dom, "data-client"));
        CHECK(attribute(dom, "data-requests") == 0);
        CHECK(attribute(dom, "data-pictures") == 6);
        CHECK(attribute(dom, "data-pressed") == 1);
        // A vase fills a good part of the picture, and never all of it.
        CHECK(attribute(dom, "data-view") > 0.03);
        CHECK(attribute(dom, "data-view") < 0.9);
    }
    // The page as it is: straight from its file, and not a word on the console.
    const std::string dom = shown_by_browser(folder, folder / "vase.html", 1200);
    CHECK(attribute(dom, "data-filled") > 0.03);
    CHECK(slurp(folder / "log").find("CONSOLE") == std::string::npos);
}

}  // namespace
}  // namespace fretwork::testing
