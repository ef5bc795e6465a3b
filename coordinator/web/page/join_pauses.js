// The reasons why this device pauses: the user, a hidden page, a low battery.

const lowBattery = 0.2;  // share of a full battery

export class Pauses {
  byUser = false;
  #mayHide = false;
  #batteryIsLow = false;
  #changed;
  #was = "";

  /// `changed`: called with the new reason whenever the reason changes after the constructor. An
  /// empty reason means that rendering may go on.
  constructor(changed) {
    this.#changed = changed;
    document.addEventListener("visibilitychange", () => this.#update());
    // Not every browser has getBattery(). A browser that has it offers it only to pages that come
    // by HTTPS or from this machine.
    navigator.getBattery?.().then((battery) => {
      const check = () => {
        this.#batteryIsLow = !battery.charging && battery.level < lowBattery;
        this.#update();
      };
      battery.addEventListener("chargingchange", check);
      battery.addEventListener("levelchange", check);
      check();
    }, () => {});
  }

  setByUser(paused) {
    this.byUser = paused;
    this.#update();
  }
  /// `may`: whether rendering goes on while the page is hidden.
  setMayHide(may) {
    this.#mayHide = may;
    this.#update();
  }

  /// Returns the reason of the pause, a sentence, or "" if rendering may go on.
  reason() {
    if (this.byUser) return "Paused";
    if (this.#batteryIsLow) return "Paused: the battery is below 20 % and not charging";
    if (document.hidden && !this.#mayHide) return "Paused while this page is hidden";
    return "";
  }

  #update() {
    if (this.reason() === this.#was) return;
    this.#was = this.reason();
    this.#changed(this.#was);
  }
}
