#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace vitruvian {

/// What went wrong, one value a cause that a user can act on. The same codes cross the WASM boundary and
/// appear in the CLI's `--json` output.
enum class ErrorCode {
  usage,               ///< an option or setting is wrong or contradicts another
  not_available,       ///< a documented feature that this build does not offer
  unsupported_format,  ///< the file's kind is not one we read
  bad_file,            ///< the file is damaged, truncated or contradicts itself
  no_geometry,         ///< the file is sound but holds too little geometry to register
  bad_model,           ///< a body model, prior or network file is unusable
  cannot_read,         ///< the operating system refused to read
  cannot_write,        ///< the operating system refused to write
  cancelled,           ///< the caller asked to stop
  internal,            ///< a broken invariant of ours
};

/// Stable lower-case name of a code, e.g. "bad_file".
std::string_view name_of(ErrorCode code) noexcept;

/// The one exception type of the core. The message names the file, the place in it, what is wrong and, where
/// there is one, the mend.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace vitruvian
