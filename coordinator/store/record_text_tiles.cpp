#include "coordinator/store/record_text_tiles.h"

#include <string>

namespace bandsaw::coordinator {

const char* write_tiles(FieldWriter& out, const record::TilesPlanned& r) {
  out.number("job", r.job);
  out.number("pilot", r.plan.pilot);
  out.text("levels", r.plan.levels);
  return "tiles_planned";
}

Record read_tiles(FieldReader& in) {
  record::TilesPlanned planned{
      .job = in.number("job"),
      .plan = {.pilot = in.number("pilot", kMaxSamples), .levels = in.text("levels")}};
  if (planned.plan.levels.find_first_not_of("0123456789abcdef") != std::string::npos) {
    in.refuse("field 'levels': must be digits 0 to f");
  }
  return planned;
}

}  // namespace bandsaw::coordinator
