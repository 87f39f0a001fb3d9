#include "context.hpp"

namespace thicket {

std::vector<Experiment> billdal2018_experiments() { return {}; }

}  // namespace thicket
