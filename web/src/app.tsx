/** The whole: the pages of all features, the menu of a role, and what an ended session does to them. */
import { QueryClient, QueryClientProvider, useQuery } from '@tanstack/react-query';
import { Suspense, type ReactNode } from 'react';
import { Link, Redirect, Route, Switch, useLocation } from 'wouter';
import { ApiError, endSession, onSessionEnd, sessionQuery } from '@/api';
import { Account, SessionGate, useAccountLanguage, useChooseLanguage } from '@/features/session';
import { say, useLanguage } from '@/language';
import { type Feature, Notice, Shell, Skeleton, useTitle } from '@/ui';
import styles from './app.module.css';
import { Fault } from './fault';
/** Every folder of features/ that has a manifest: there is no list to edit. */
const kFeatures = Object.values(
  import.meta.glob<{ feature: Feature }>('./features/*/manifest.tsx', { eager: true }),
).map(({ feature }) => feature);
/** A fixed segment ("new") is tried before a parameter (":id"). */
const kPages = kFeatures
  .flatMap(({ pages }) => pages)
  .sort((a, b) => (a.path.replaceAll(':', '~') < b.path.replaceAll(':', '~') ? -1 : 1));
const kMenu = kFeatures.flatMap(({ menu }) => menu).sort((a, b) => a.order - b.order);

export function makeClient(): QueryClient {
  const client = new QueryClient({
    // The server is in the house: whether the browser thinks that there is an Internet says nothing about it.
    defaultOptions: {
      mutations: { networkMode: 'always' },
      queries: {
        networkMode: 'always',
        staleTime: 5_000,
        retry: (failures, reason) =>
          failures < 2 &&
          reason instanceof ApiError &&
          (reason.code === 'unreachable' || reason.code === 'unavailable'),
        retryDelay: (failures) => 500 * 2 ** failures,
      },
    },
  });
  onSessionEnd(() => endSession(client));
  return client;
}

const open = (role: string) => kMenu.filter(({ roles }) => roles.some((one) => one === role));

function Brand() {
  const [at] = useLocation();
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  return (
    <div className={styles.home}>
      <Link href="/" className={styles.brand}>
        <img src="/icon.svg" alt="" width="24" height="24" />
        Tractus
      </Link>
      {role === undefined ? null : (
        <nav aria-label={say('Pages')} className={styles.places}>
          {open(role).map(({ to, name }) => (
            <Link
              key={to}
              href={to}
              className={styles.place}
              aria-current={at === to || at.startsWith(`${to}/`) ? 'page' : undefined}
            >
              {say(name)}
            </Link>
          ))}
        </nav>
      )}
    </div>
  );
}

/** Where a role begins. */
function Home() {
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role ?? '';
  return <Redirect to={open(role)[0]?.to ?? '/account'} replace />;
}

function NotFound() {
  useTitle(say('Page not found'));
  return (
    <div className={styles.narrow}>
      <h1>{say('Page not found')}</h1>
      <p>{say('Check the address. The page may have been removed.')}</p>
      <p>
        <Link href="/">{say('Go to the start page')}</Link>
      </p>
    </div>
  );
}

function Loading() {
  return (
    <div className={styles.loading} role="status">
      <span className="hidden-visually">{say('Loading')}</span>
      <Skeleton height="40px" width="320px" />
    </div>
  );
}

function Pages() {
  return (
    <Suspense fallback={<Loading />}>
      <Switch>
        <Route path="/">
          <Home />
        </Route>
        {kPages.map(({ path, show }) => (
          <Route key={path} path={path}>
            {(parameters: Record<string, string | undefined>) => show((name) => parameters[name] ?? '')}
          </Route>
        ))}
        <Route>
          <NotFound />
        </Route>
      </Switch>
    </Suspense>
  );
}

function Framed({ children }: { readonly children: ReactNode }) {
  const chooseLanguage = useChooseLanguage();
  useAccountLanguage();
  // The role's menu makes the header higher: drawn before the role is known, it would push the page down.
  if (useQuery(sessionQuery).isPending) return <Loading />;
  return (
    <Shell home={<Brand />} account={<Account />} onLanguage={chooseLanguage}>
      {children}
    </Shell>
  );
}

export function App({ client }: { readonly client: QueryClient }) {
  const spoken = useLanguage();
  return (
    <QueryClientProvider client={client}>
      <Framed key={spoken}>
        <Fault
          fallback={
            <Notice tone="bad" title={say('This page stopped working.')}>
              {say('Reload the page. If the error occurs again, tell the administrator of this server what you did.')}
            </Notice>
          }
        >
          <SessionGate waiting={<Loading />}>
            <Pages />
          </SessionGate>
        </Fault>
      </Framed>
    </QueryClientProvider>
  );
}
