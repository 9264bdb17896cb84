#include "base/error.h"

namespace vitruvian {

std::string_view name_of(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::usage:
      return "usage";
    case ErrorCode::not_available:
      return "not_available";
    case ErrorCode::unsupported_format:
      return "unsupported_format";
    case ErrorCode::bad_file:
      return "bad_file";
    case ErrorCode::no_geometry:
      return "no_geometry";
    case ErrorCode::bad_model:
      return "bad_model";
    case ErrorCode::cannot_read:
      return "cannot_read";
    case ErrorCode::cannot_write:
      return "cannot_write";
    case ErrorCode::cancelled:
      return "cancelled";
    case ErrorCode::internal:
      return "internal";
  }
  return "internal";
}

}  // namespace vitruvian
