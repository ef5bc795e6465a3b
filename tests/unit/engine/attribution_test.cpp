// Attribution: which worker rendered which rows of an image. The arguments of `add` are a job,
// rows, the id of the worker's process and the worker's name.

#include "coordinator/engine/attribution.h"

#include <gmock/gmock.h>

namespace bandsaw::coordinator {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Attribution, TheLastWorkerOfARowIsReturned) {
  Attribution attribution;
  attribution.add(1, {0, 10}, 1, "anna");
  attribution.add(1, {20, 30}, 2, "ben");
  attribution.add(1, {5, 22}, 3, "cleo");
  EXPECT_THAT(attribution.of(1), ElementsAre(RowsBy{{0, 5}, "anna"}, RowsBy{{5, 22}, "cleo"},
                                             RowsBy{{22, 30}, "ben"}));
  attribution.add(1, {7, 9}, 1, "anna");
  EXPECT_THAT(attribution.of(1),
              ElementsAre(RowsBy{{0, 5}, "anna"}, RowsBy{{5, 7}, "cleo"}, RowsBy{{7, 9}, "anna"},
                          RowsBy{{9, 22}, "cleo"}, RowsBy{{22, 30}, "ben"}));
  attribution.add(1, {0, 30}, 2, "ben");
  EXPECT_THAT(attribution.of(1), ElementsAre(RowsBy{{0, 30}, "ben"}));
}

TEST(Attribution, AdjacentRowsOfOneWorkerAreMerged) {
  Attribution attribution;
  attribution.add(1, {10, 20}, 1, "anna");
  attribution.add(1, {0, 10}, 1, "anna");
  attribution.add(1, {20, 21}, 7, "");
  EXPECT_THAT(attribution.of(1), ElementsAre(RowsBy{{0, 20}, "anna"}, RowsBy{{20, 21}, ""}));
}

TEST(Attribution, JobsThatAreOverAreForgotten) {
  Attribution attribution;
  attribution.add(1, {0, 1}, 1, "anna");
  attribution.add(2, {0, 1}, 1, "anna");
  attribution.forget(1);
  EXPECT_THAT(attribution.of(1), IsEmpty());
  EXPECT_EQ(attribution.of(2).size(), 1u);
}

TEST(Attribution, ALaterNameAppliesToEarlierRows) {
  Attribution attribution;
  attribution.add(1, {0, 10}, 1, "");
  attribution.add(1, {20, 30}, 2, "ben");
  EXPECT_THAT(attribution.of(1), ElementsAre(RowsBy{{0, 10}, ""}, RowsBy{{20, 30}, "ben"}));
  attribution.add(1, {10, 15}, 1, "anna");
  EXPECT_THAT(attribution.of(1), ElementsAre(RowsBy{{0, 15}, "anna"}, RowsBy{{20, 30}, "ben"}));
}

}  // namespace
}  // namespace bandsaw::coordinator
