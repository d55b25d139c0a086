#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>

#include "core/base/error.h"

namespace fretwork::cli {
namespace {

using Clock = std::chrono::steady_clock;

class Bar {
  public:
    Bar() = default;
    Bar(const Bar&) = delete;
    Bar& operator=(const Bar&) = delete;
    ~Bar() {
        if (shown_) fmt::print(stderr, "\r\033[K");
    }
    void show(std::string_view stage, double fraction) {
        const auto now = Clock::now();
        if (shown_ && fraction < 1.0 && now - last_ < std::chrono::milliseconds(80)) return;
        last_ = now;
        shown_ = true;
        constexpr int width = 30;
        const auto filled = static_cast<std::size_t>(fraction * width);
        const double seconds = std::chrono::duration<double>(now - start_).count();
        fmt::print(stderr, "\r\033[K[{}{}] {:3.0f} %  {:<10} {:.0f} s", std::string(filled, '#'),
                   std::string(width - filled, '.'), fraction * 100.0, stage, seconds);
        std::fflush(stderr);
    }

  private:
    bool shown_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_ = start_;
};

class JsonLines {
  public:
    void show(std::string_view stage, double fraction) {
        constexpr double step = 0.002;
        if (stage == stage_ && fraction < shown_ + step && fraction < 1.0) return;
        if (stage == stage_ && fraction == shown_) return;
        stage_ = stage;
        shown_ = fraction;
        fmt::print(stderr, "{{\"stage\": \"{}\", \"fraction\": {:.4f}}}\n", stage, fraction);
        std::fflush(stderr);
    }

  private:
    std::string stage_;
    double shown_ = -1.0;
};

template <class View>
RunControl shown_on(std::stop_token stop) {
    auto view = std::make_shared<View>();
    return RunControl([view](std::string_view stage, double fraction) { view->show(stage, fraction); },
                      std::move(stop));
}

}  // namespace

ProgressStyle progress_style(const std::string& name) {
    if (name == "none") return ProgressStyle::kNone;
    if (name == "json") return ProgressStyle::kJson;
    if (name == "auto") return ProgressStyle::kAuto;
    throw InvalidSetting(fmt::format("--progress {}: expected auto, none or json", name));
}

RunControl shown_progress(ProgressStyle style, std::stop_token stop) {
    if (style == ProgressStyle::kJson) return shown_on<JsonLines>(std::move(stop));
    if (style == ProgressStyle::kAuto && ::isatty(STDERR_FILENO) == 1) return shown_on<Bar>(std::move(stop));
    return RunControl(nullptr, std::move(stop));
}

}  // namespace fretwork::cli
