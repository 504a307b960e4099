// What an EXR's header tells beside its windows and channels.
#pragma once

#include <map>
#include <string>

#include "field/base/result.h"
#include "renderer/output/picture.h"

namespace marrow {

/// By name.
using HeaderEntries = std::map<std::string, Metadata>;

/// The picture's own metadata over what every picture has: Software, capDate (SOURCE_DATE_EPOCH, if it is set) and
/// colorInteropID. An error when SOURCE_DATE_EPOCH is no time.
Result<HeaderEntries> header_entries(const PictureRows&);

}  // namespace marrow
