/** Somebody at a kiosk's screen: a scanner types the badge, a finger does the rest. */
import type { Browser, Page } from 'playwright-core';
import { Words } from './words';

const kTrial_ms = 90_000;

export class KioskPerson {
  private constructor(
    readonly page: Page,
    private readonly words: Words,
  ) {}

  static async before(browser: Browser, address: string, words = new Words('en')): Promise<KioskPerson> {
    const page = await browser.newPage({ locale: words.locale, viewport: { width: 1200, height: 750 } });
    await page.goto(address);
    return new KioskPerson(page, words);
  }

  /** Waits for what `selector` names; an error tells what the kiosk shows instead. */
  private async shows(selector: string): Promise<void> {
    try {
      await this.page.locator(selector).waitFor({ timeout: kTrial_ms });
    } catch {
      throw new Error(`not ${selector}, but: ${await this.page.locator('body').innerText()}`);
    }
  }
  screen(name: string): Promise<void> {
    return this.shows(`[data-screen="${name}"]`);
  }
  fault(kind: string): Promise<void> {
    return this.shows(`[data-fault="${kind}"]`);
  }
  touch(name: string | RegExp): Promise<void> {
    return this.page.getByRole('button', { name }).click();
  }
  async says(text: string | RegExp): Promise<void> {
    await this.page.getByText(text).first().waitFor({ timeout: kTrial_ms });
  }

  async scan(badge: string): Promise<void> {
    await this.page.locator('[data-screen="badge"], [data-fault="interrupted"]').waitFor();
    await this.page.keyboard.type(`${badge}\n`);
  }
  async signIn(badge: string, pin: string): Promise<void> {
    await this.scan(badge);
    await this.screen('pin');
    for (const digit of pin) await this.page.getByRole('button', { name: digit, exact: true }).click();
    await this.touch(this.words.said('OK'));
    await this.screen('work');
  }
  async answer(wall: string, sure: RegExp): Promise<void> {
    await this.screen('answer');
    await this.touch(wall);
    await this.touch(sure);
    await this.touch(this.words.said('Give the answer'));
  }
}
