// Until reading of maps is merged. Delete this file then.
#include "thicket/sim/problem.hpp"

namespace thicket {

Result<ReadProblems> read_problems(const std::filesystem::path&, const MapProblems&, const Robot&) { return Error{"problems from maps are not merged yet"}; }

}  // namespace thicket
