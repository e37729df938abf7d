// The words of model/element.h under the names that element generators use.
#pragma once

#include "pipeline/model/element.h"

namespace blockrand::elements {

using model::Element;
using model::ElementClass;
using model::ElementFace;
using model::ElementMesh;
using model::OpeningOutline;
using Part = model::ElementPart;
inline constexpr int kPartCount = model::kElementPartCount;

}  // namespace blockrand::elements
