// What the heap gives back to the system, whichever allocator the program is linked with.
#pragma once

namespace blockrand::base {

/// What is free goes back to the system: after a stage that needed much more than the next one.
void give_memory_back();

/// Of this process from here on: what is freed goes back to the system soon, and no huge pages. Less memory at the peak, a little more time.
void keep_memory_low();

}  // namespace blockrand::base
