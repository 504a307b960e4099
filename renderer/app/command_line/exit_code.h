// How the program ends: what a script or a farm reads from it.
#pragma once

namespace marrow {

/// The numbers from 64 are those of BSD's sysexits.h.
enum class ExitCode {
  Ok = 0,
  Doubtful = 1,       ///< done, but with warnings about correctness, and --strict was given
  Usage = 2,          ///< the command line is wrong
  BadInput = 65,      ///< a scene or a list of points has mistakes
  NoInput = 66,       ///< a file of the command line is missing or cannot be read
  Unavailable = 69,   ///< a library or an instruction set is missing
  Internal = 70,      ///< our mistake, or out of memory
  CannotCreate = 73,  ///< an output cannot be written: found before the work
  WriteFailed = 74,   ///< an output could not be written: found after the work
  Interrupted = 75,   ///< stopped by a signal; what was finished is written
};

}  // namespace marrow
