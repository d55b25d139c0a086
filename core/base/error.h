// What can go wrong, by cause. The command line maps each cause to its exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace fretwork {

/// Base of every error Fretwork throws on purpose. The message names the place, what was found and
/// what was expected.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A setting or a spec is unknown, malformed or out of range (exit code 1).
class InvalidSetting : public Error {
    using Error::Error;
};

/// Data that was handed in cannot be used: a mesh without triangles, a picture of one pixel, a
/// truncated file (exit code 2).
class InvalidInput : public Error {
    using Error::Error;
};

/// A file cannot be opened, written or replaced (exit code 2).
class FileError : public Error {
    using Error::Error;
};

/// Each setting is fine by itself, but together they cannot be met (exit code 3). The message names
/// both values and one that would work.
class ConstraintsNotMet : public Error {
    using Error::Error;
};

/// A numerical method broke down; always our fault (exit code 5).
class SolverFailure : public Error {
    using Error::Error;
};

/// The run would need more memory than it was allowed (exit code 3).
class MemoryLimit : public ConstraintsNotMet {
    using ConstraintsNotMet::ConstraintsNotMet;
};

/// Somebody asked to stop (exit code 130). Nothing is returned and nothing is left behind.
class Cancelled : public Error {
  public:
    Cancelled() : Error("cancelled") {}
};

}  // namespace fretwork
