// How long a carve with its full analysis goes on after it was asked to stop, at many moments of the run, in Markdown
// on stdout.
//   cancel_latency MESH [RESOLUTION [MOMENTS]]
// Each moment is a run of its own that is asked to stop then; the promise is 0.2 s (a machine with other work on it
// shows more). The worst moment of each stage is printed.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/pipeline/carve.h"
#include "core/pipeline/choose_exemplar.h"
#include "formats/mesh_file.h"

namespace {

using namespace fretwork;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Stopped {
    std::string stage;   ///< the last one that reported progress
    double wait_s = -1;  ///< from the request to the end; below 0 if the run had ended before
};

Stopped stop_after(const CarveInput& input, const Settings& settings, double seconds) {
    Stopped result;
    std::stop_source stop;
    const RunControl run([&](std::string_view stage, double) { result.stage = std::string(stage); }, stop.get_token());
    Clock::time_point asked{};
    std::atomic<bool> done{false};
    std::jthread clock([&] {
        const Clock::time_point start = Clock::now();
        while (!done && seconds_since(start) < seconds) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        asked = Clock::now();
        stop.request_stop();
    });
    try {
        carve(input, settings, {}, run);
        done = true;
        return result;
    } catch (const Cancelled&) {
        const Clock::time_point ended = Clock::now();
        clock.join();
        result.wait_s = std::chrono::duration<double>(ended - asked).count();
        return result;
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: cancel_latency MESH [RESOLUTION [MOMENTS]]\n");
        return 1;
    }
    Settings settings;
    settings.input.size_mm = 100.0;
    settings.exemplar.pattern = "cells";
    settings.structure.verify_rounds = 1;
    settings.shell.resolution = argc > 2 ? std::stoi(argv[2]) : 256;
    const int moments = argc > 3 ? std::stoi(argv[3]) : 32;
    ChosenExemplar chosen = builtin_exemplar(settings.exemplar);
    CarveInput input;
    input.mesh = read_mesh(argv[1]).mesh;
    input.exemplar = std::move(chosen.exemplar);
    input.exemplar_width_mm = chosen.natural_width_mm;

    const Clock::time_point start = Clock::now();
    carve(input, settings);
    const double whole = seconds_since(start);
    std::map<std::string, std::pair<int, double>> worst;
    for (int m = 0; m < moments; ++m) {
        const Stopped s = stop_after(input, settings, whole * (m + 0.5) / moments);
        if (s.wait_s < 0) continue;
        auto& [count, seconds] = worst[s.stage];
        ++count;
        seconds = std::max(seconds, s.wait_s);
    }
    fmt::print("Whole run {:.1f} s; stops asked for at {} moments of it.\n\n", whole, moments);
    fmt::print("| after progress of | stops | longest wait, s |\n|---|---|---|\n");
    for (const auto& [stage, found] : worst) fmt::print("| {} | {} | {:.3f} |\n", stage, found.first, found.second);
    return 0;
}
