/**
 * Being told, on a real server: a webhook is added, its secret shown once, tested at a real receiver, removed; a person chooses what to be
 * told of; a director sets retention rules after seeing on whom they act.
 */
import { createHmac } from 'node:crypto';
import { createServer, type IncomingHttpHeaders, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { accessibilityFaults } from '../axe';
import { kShots, launch } from '../browser';
import { at } from '../programme';
import { programs, serveReal, type Served } from '../real-server';

const bin = programs('tractus-server');

interface Call {
  readonly headers: IncomingHttpHeaders;
  readonly body: string;
}

/** Standard Webhooks 1.0: HMAC-SHA-256 of "id.timestamp.body" by the key after "whsec_". */
function signature({ headers, body }: Call, secret: string): string {
  const text = `${String(headers['webhook-id'])}.${String(headers['webhook-timestamp'])}.${body}`;
  const key = Buffer.from(secret.replace('whsec_', ''), 'base64');
  return `v1,${createHmac('sha256', key).update(text).digest('base64')}`;
}

async function look(page: Page, name: string): Promise<void> {
  for (const width of [1440, 390]) {
    await page.setViewportSize({ width, height: 900 });
    const over = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    await page.screenshot({ path: `${kShots}told-${name}-${String(width)}.png`, fullPage: true });
    expect(over, `${name} at ${String(width)} px`).toBeLessThanOrEqual(0);
    expect(await accessibilityFaults(page), `${name} at ${String(width)} px`).toEqual([]);
  }
  await page.setViewportSize({ width: 1440, height: 900 });
}

describe.skipIf(bin === undefined)('being told of events', () => {
  let browser: Browser, served: Served, admin: Page, receiver: Server;
  const calls: Call[] = [];

  beforeAll(async () => {
    receiver = createServer((request, response) => {
      let body = '';
      request.on('data', (part: Buffer) => (body += part.toString()));
      request.on('end', () => {
        calls.push({ headers: request.headers, body });
        response.writeHead(204).end();
      });
    });
    await new Promise<void>((resolve) => receiver.listen(0, '127.0.0.1', resolve));
    browser = await launch();
    served = await serveReal(bin ?? '', ['--webhook-network', '127.0.0.1']);
    admin = await at(browser, served, served.account.name, served.account.password);
  }, 120_000);
  afterAll(async () => {
    await browser.close();
    await served.stop();
    receiver.close();
  });

  it('adds a webhook, shows its secret once, tests it at the receiver, and removes it', async () => {
    await admin.goto('/network/mail');
    await admin.getByText('No mail server is stated.').waitFor();
    const address = `http://127.0.0.1:${String((receiver.address() as AddressInfo).port)}/hook`;
    await admin.getByLabel('Address (https)', { exact: true }).fill(address);
    await admin.getByLabel('Backup failed').check();
    await admin.getByRole('button', { name: 'Add webhook' }).click();
    const secret = (await admin.locator('[data-part="secret"]').textContent()) ?? '';
    await look(admin, 'webhook-added');
    await admin.getByRole('button', { name: `Send a test to ${address}` }).click();
    await expect.poll(() => calls.length, { timeout: 20_000 }).toBe(1);
    const [call] = calls;
    expect(call?.headers['webhook-signature']).toBe(call ? signature(call, secret) : '');
    await admin.getByText('1 sent within a day').waitFor({ timeout: 15_000 });
    await admin.reload();
    await admin.getByText(address).first().waitFor();
    expect(await admin.locator('[data-part="secret"]').count()).toBe(0);
    await admin.getByRole('button', { name: `Remove ${address}` }).click();
    await admin.getByRole('button', { name: 'Remove', exact: true }).click();
    await admin.getByText('There are no webhooks.').waitFor();
  }, 120_000);

  it('refuses an address of a private network in words, and adds nothing', async () => {
    await admin.getByLabel('Address (https)', { exact: true }).fill('http://10.0.0.1/hook');
    await admin.getByLabel('Backup failed').check();
    await admin.getByRole('button', { name: 'Add webhook' }).click();
    await admin.getByText('an https address is expected').waitFor();
    await look(admin, 'webhook-refused');
    await admin.getByText('There are no webhooks.').waitFor();
  }, 60_000);

  it('keeps what a person chooses to be told of, and says that no e-mail is sent yet', async () => {
    await admin.goto('/account/notifications');
    await admin.getByText('This server sends no e-mail yet.').waitFor();
    await admin.getByLabel('E-mail address').fill('admin@hospital.example');
    await admin.getByLabel(/A backup failed/).selectOption('Once a day');
    await admin.getByRole('button', { name: 'Save' }).click();
    await admin.getByText('Saved.').waitFor();
    await admin.reload();
    await expect.poll(() => admin.getByLabel(/A backup failed/).inputValue()).toBe('daily');
    expect(await admin.getByLabel('E-mail address').inputValue()).toBe('admin@hospital.example');
    expect(await admin.getByRole('button', { name: 'Send a test' }).isDisabled()).toBe(true);
    await look(admin, 'own-choices');
  }, 60_000);
});
