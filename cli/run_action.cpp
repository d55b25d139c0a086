#include <fmt/format.h>

#include <exception>
#include <new>

#include "cli/command.h"
#include "core/base/error.h"

namespace fretwork::cli {
namespace {

int fail(ExitCode code, std::string message) {
    // One line, whatever a library put into its message.
    for (char& c : message)
        if (c == '\n' || c == '\r') c = ' ';
    fmt::print(stderr, "fretwork: error: {}\n", message);
    return code;
}

}  // namespace

int run_action(const Action& action, Interrupt& interrupt) {
    try {
        return action(interrupt);
    } catch (const Cancelled&) {
        fmt::print(stderr, "fretwork: cancelled\n");
        return kCancelled;
    } catch (const InvalidSetting& error) {
        return fail(kBadUsage, error.what());
    } catch (const InvalidInput& error) {
        return fail(kBadInput, error.what());
    } catch (const FileError& error) {
        return fail(kBadInput, error.what());
    } catch (const ConstraintsNotMet& error) {
        return fail(kCannotBeMet, error.what());
    } catch (const std::bad_alloc&) {
        return fail(kCannotBeMet, "out of memory; a lower shell.resolution needs less");
    } catch (const std::exception& error) {
        return fail(kInternalError, fmt::format("internal error: {}", error.what()));
    }
}

}  // namespace fretwork::cli
